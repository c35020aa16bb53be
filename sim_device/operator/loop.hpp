#pragma once
// The loop of a throw, seen anew at each look.

#include "sim_device/operator/move.hpp"

namespace ligature::sim {

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

}  // namespace ligature::sim
