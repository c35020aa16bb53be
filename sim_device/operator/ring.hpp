#pragma once
// A closed loop of thread, as a polygon.

#include <vector>

#include "sim_device/operator/sight.hpp"

namespace ligature::sim {

/// A closed polygon in space.
class Ring {
 public:
  /// @param points three or more, in order; the last is connected to the first.
  explicit Ring(std::vector<Vec3> points);

  /// Centre of the edges, weighted by length, m.
  [[nodiscard]] const Vec3& centre() const noexcept { return centre_; }
  /// Unit normal of the area vector A = 1/2 sum (p_k - c) x (p_k+1 - c), by the right-hand rule.
  [[nodiscard]] const Vec3& normal() const noexcept { return normal_; }
  /// |A|, m^2: area of the projection along the normal.
  [[nodiscard]] double area_m2() const noexcept { return area_m2_; }

 private:
  std::vector<Vec3> points_;
  Vec3 centre_ = Vec3::Zero(), normal_ = Vec3::UnitZ();
  double area_m2_ = 0.0;
};

}  // namespace ligature::sim
