#pragma once
// Geometry of the loop of a throw, computed anew each time the operator looks at the thread.

#include "sim_device/operator/move.hpp"

namespace ligature::sim {

/// The loop through which the end is passed. It consists of the standing part between the crossing X and the corner
/// (where the left hand holds the thread), and the working part from the corner out to the bight and back to X, where
/// it comes closest to the standing part. Positions are given as angles about the standing part: 0 in front, a quarter
/// turn above, half a turn behind (for side +1; for side -1 front and behind are swapped). A stiff thread's loop may
/// point in any direction, so the end's turn is measured from the direction of the loop.
class Loop {
 public:
  /// @param corner position of the corner along the thread, m. @param side sense of the turn, +1 or -1.
  Loop(WhereAlong corner, int side) : corner_(std::move(corner)), side_(side) {}

  /// Recomputes everything from the thread's present shape. Cost: some hundred searches for a nearest point, O(n) each.
  void look(const Look& look);

  [[nodiscard]] Vec3 centre() const noexcept { return centre_W_; }
  /// Crossing point X of working part and standing part.
  [[nodiscard]] Vec3 crossing() const noexcept { return crossing_W_; }
  /// Unit normal of the loop, on the side to which the turn passes through it.
  [[nodiscard]] Vec3 normal() const noexcept { return normal_W_; }
  /// Direction through the loop in the sense of the turn.
  [[nodiscard]] Vec3 way() const noexcept { return towards(angle_ + 0.5 * kPi); }
  /// Angle by which the working part has turned around the standing part, from the loop to the end, rad.
  [[nodiscard]] double wound() const noexcept { return wound_; }
  /// Length of thread in the loop, m.
  [[nodiscard]] double around_m() const noexcept { return working_ - standing_; }
  /// towards(): unit vector perpendicular to the standing part at an angle. angle_of(): angle of a point. along(): unit
  /// vector along the standing part, away from the anchor.
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
