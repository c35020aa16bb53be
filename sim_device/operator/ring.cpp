#include "sim_device/operator/ring.hpp"

#include <Eigen/Geometry>
#include <utility>

namespace ligature::sim {

Ring::Ring(std::vector<Vec3> points) : points_(std::move(points)) {
  const std::size_t n = points_.size();
  double total = 0.0;
  for (std::size_t k = 0; k < n; ++k) {
    const Vec3 &a = points_[k], &b = points_[(k + 1) % n];
    const double length = (b - a).norm();
    centre_ += 0.5 * length * (a + b);
    total += length;
  }
  if (total > 0.0) centre_ /= total;
  Vec3 area = Vec3::Zero();
  for (std::size_t k = 0; k < n; ++k) area += 0.5 * (points_[k] - centre_).cross(points_[(k + 1) % n] - centre_);
  area_m2_ = area.norm();
  if (area_m2_ > 0.0) normal_ = area / area_m2_;
}

}  // namespace ligature::sim
