#pragma once
// What hands do with a thread: reach, pinch, carry, let go, hand over, lay a turn around the standing part, pass the
// end through a loop, pull tight. Each looks at the thread as it is now; none knows a node number.

#include <memory>

#include "sim_device/operator/move.hpp"

namespace ligature::sim {

/// The tip goes to the place `s` of the thread, from the front (-y), and follows it until it is there.
[[nodiscard]] Move reach(std::size_t hand, WhereAlong s);
/// The jaws close, or open, and get a moment to do so.
[[nodiscard]] Move pinch(std::size_t hand);
[[nodiscard]] Move let_go(std::size_t hand);
/// To a place that may move; done within `near` clearances of it. @param pace share of full speed
[[nodiscard]] Move carry(std::size_t hand, std::string name, Where where, double near = 0.5, double pace = 1.0);
/// Stay for a while.
[[nodiscard]] Move wait(double seconds);
/// Until the end of the hanging thread no longer swings.
[[nodiscard]] Move hang_out();
/// `to` takes the thread beside the place that `from` holds; when it has it, `from` lets go.
[[nodiscard]] Moves hand_over(std::size_t from, std::size_t to);

/// The loop that an end is tied through: the standing part between the crossing X and the corner, where one hand holds
/// the thread, and the working part from there out to the bight and back to X, where it is nearest to the standing
/// part. All is seen in angles about the standing part: 0 in front of it, a quarter turn above, a half behind (side +1;
/// for side -1 front and behind change places). A stiff thread's loop stands out where it likes, so the turn that the
/// end has made is counted from there.
class Loop {
 public:
  /// @param corner place of the corner along the thread, m;  @param side which way round, +1 or -1
  Loop(WhereAlong corner, int side) : corner_(std::move(corner)), side_(side) {}

  /// Looks at it anew. O(n^2) with a small n.
  void look(const Look& look);

  [[nodiscard]] Vec3 centre() const noexcept { return centre_W_; }
  /// Where the working part crosses the standing part.
  [[nodiscard]] Vec3 crossing() const noexcept { return crossing_W_; }
  /// Unit normal of the loop, on the side where the turn passes it.
  [[nodiscard]] Vec3 normal() const noexcept { return normal_W_; }
  /// Through the loop, in the sense of the turn.
  [[nodiscard]] Vec3 way() const noexcept { return towards(angle_ + 0.5 * kPi); }
  /// How far the working part has gone round the standing part, from the loop on to the end, rad.
  [[nodiscard]] double wound() const noexcept { return wound_; }
  /// Length of thread in the loop, m.
  [[nodiscard]] double around_m() const noexcept { return working_ - standing_; }
  /// Unit vector across the standing part at an angle; the angle of a point; along it, away from the anchor.
  [[nodiscard]] Vec3 towards(double angle) const;
  [[nodiscard]] double angle_of(const Look& look, const Vec3& p_W) const;
  [[nodiscard]] const Vec3& along() const noexcept { return along_; }

 private:
  static constexpr double kPi = 3.14159265358979323846;
  [[nodiscard]] Vec3 off(const Look& look, const Vec3& p_W) const;
  [[nodiscard]] double wind(const Look& look, double from, double to) const;

  WhereAlong corner_;
  int side_;
  Vec3 along_ = Vec3::UnitX(), up_ = Vec3::UnitZ(), front_ = Vec3::UnitY();
  Vec3 centre_W_ = Vec3::Zero(), crossing_W_ = Vec3::Zero(), normal_W_ = Vec3::UnitY();
  double corner_s_ = 0.0, standing_ = 0.0, working_ = 0.0, far_ = -1.0, angle_ = 0.0, wound_ = 0.0;
};

/// How a turn is laid and how the end goes through.
struct Throw {
  int side = 1;          ///< +1: one turn makes a right-handed trefoil; -1: its mirror image in y
  bool against = false;  ///< through the loop against the turn (figure-eight) instead of with it
  int passes = 1;        ///< how often the end goes round the loop's edge (2: a surgeon's first throw)
  int tied_already = 1;  ///< determinant of the throws before it on the thread (diagram.hpp)
};

/// What a throw multiplies the thread's determinant by: n turns make a torus knot of 2 n + 1 half turns.
[[nodiscard]] int determinant_of(const Throw& t);
/// With both ends led away along `out`, would the thread hold this throw and all before it? (diagram.hpp)
[[nodiscard]] bool would_hold(const Look& look, const Throw& t, const Vec3& out);

/// The end, held by the right hand, goes around the standing part at place `s` until it is just short of the loop,
/// behind it; against the turn: once more round, nearer to the anchor than X, and in front of it.
[[nodiscard]] Moves lay_turn(std::shared_ptr<Loop> loop, const Throw& t, WhereAlong s);
/// The end goes through the loop. Looked at (over, under: is it a knot?) and done again when it missed.
[[nodiscard]] Moves pass_through(std::shared_ptr<Loop> loop, const Throw& t, WhereAlong s);
/// The right hand draws the end out along `direction`, past the corner that the left hand still holds, until the loop
/// is small or the pull is felt: so the knot forms where the corner is, and does not run off the end.
[[nodiscard]] Move draw_through(std::shared_ptr<Loop> loop, const Throw& t, Vec3 direction);
/// The right hand draws away from the anchor along `direction` until the pull is `share` of a tight knot's.
[[nodiscard]] Moves pull_tight(Vec3 direction, double share);
/// The right hand swings the thread about the anchor until it points along `direction`, no further out than it is.
[[nodiscard]] Move swing(Vec3 direction);
/// Back again until the pull is gone.
[[nodiscard]] Move ease();

}  // namespace ligature::sim
