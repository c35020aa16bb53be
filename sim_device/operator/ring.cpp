#include "sim_device/operator/ring.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <utility>

namespace ligature::sim {
namespace {

double volume(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) noexcept {
  return (b - a).cross(c - a).dot(d - a);
}

/// +1, -1 or 0: does the step from p to q pass the triangle a b c, and to which side of it? Two triangles that share
/// the edge from a decide it alike, so a step through that edge counts once.
int crossing(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b, const Vec3& c) noexcept {
  const bool before = volume(a, b, c, p) > 0.0, after = volume(a, b, c, q) > 0.0;
  if (before == after) return 0;
  const bool s1 = volume(p, q, a, b) > 0.0, s2 = volume(p, q, b, c) > 0.0, s3 = !(volume(p, q, a, c) > 0.0);
  if (s1 != s2 || s2 != s3) return 0;
  return after ? 1 : -1;
}

}  // namespace

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

int Ring::passes(std::span<const Vec3> curve) const noexcept {
  int sum = 0;
  const std::size_t n = points_.size();
  for (std::size_t i = 0; i + 1 < curve.size(); ++i) {
    for (std::size_t k = 0; k < n; ++k)
      sum += crossing(curve[i], curve[i + 1], centre_, points_[k], points_[(k + 1) % n]);
  }
  return sum;
}

}  // namespace ligature::sim
