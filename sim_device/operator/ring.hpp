#pragma once
// A loop of thread as a hole that an end can be passed through.

#include <vector>

#include "sim_device/operator/sight.hpp"

namespace ligature::sim {

/// A closed polygon in space and the disc it spans, taken as the fan of triangles from its centre.
class Ring {
 public:
  /// @param points three or more, in order; the last is joined to the first.
  explicit Ring(std::vector<Vec3> points);

  /// Mean of the edge, weighted by length, m.
  [[nodiscard]] const Vec3& centre() const noexcept { return centre_; }
  /// Unit normal of the area vector A = 1/2 sum (p_k - c) x (p_k+1 - c): thumb of a right hand that follows the ring.
  [[nodiscard]] const Vec3& normal() const noexcept { return normal_; }
  /// |A|, m^2: what is left of the hole when it is looked at along the normal.
  [[nodiscard]] double area_m2() const noexcept { return area_m2_; }

 private:
  std::vector<Vec3> points_;
  Vec3 centre_ = Vec3::Zero(), normal_ = Vec3::UnitZ();
  double area_m2_ = 0.0;
};

}  // namespace ligature::sim
