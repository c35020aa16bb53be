#include "sim_device/operator/diagram.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace ligature::sim {
namespace {

/// A crossing of two strands in the projection, met while following the thread (each crossing is met twice).
struct Visit {
  double at;  ///< edge index plus fraction along the edge
  int crossing;
  bool over;
};

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

/// All crossings in order along the thread. The edge that closes the thread, from one end to the other, passes over all
/// strands.
std::vector<Visit> visits(std::span<const Vec3> p, const Vec3& eye) {
  const Vec3 right = eye.unitOrthogonal(), up = eye.cross(right);
  const std::size_t n = p.size();
  std::vector<Eigen::Vector2d> seen;
  for (const Vec3& q : p) seen.emplace_back(q.dot(right), q.dot(up));
  std::vector<Visit> found;
  int crossings = 0;
  const auto height = [&](std::size_t i, double share) {
    if (i + 1 == n) return std::numeric_limits<double>::infinity();
    return eye.dot(p[i] + share * (p[i + 1] - p[i]));
  };
  for (std::size_t i = 0; i < n; ++i) {
    const Eigen::Vector2d& a = seen[i];
    const Eigen::Vector2d u = seen[(i + 1) % n] - a;
    for (std::size_t j = i + 2; j < n; ++j) {
      if (i == 0 && j + 1 == n) continue;
      const Eigen::Vector2d b = seen[j] - a, v = seen[(j + 1) % n] - seen[j];
      const double area = cross(u, v);
      if (area == 0.0) continue;
      const double s = cross(b, v) / area, t = cross(b, u) / area;
      if (s < 0.0 || s >= 1.0 || t < 0.0 || t >= 1.0) continue;
      const bool first_over = height(i, s) > height(j, t);
      found.push_back({static_cast<double>(i) + s, crossings, first_over});
      found.push_back({static_cast<double>(j) + t, crossings, !first_over});
      ++crossings;
    }
  }
  std::sort(found.begin(), found.end(), [](const Visit& a, const Visit& b) { return a.at < b.at; });
  return found;
}

}  // namespace

int seen_determinant(std::span<const Vec3> thread_W, const Vec3& towards) {
  const auto order = visits(thread_W, towards.normalized());
  const auto m = static_cast<Eigen::Index>(order.size() / 2);
  if (m < 3) return 1;
  Eigen::MatrixXd colours = Eigen::MatrixXd::Zero(m, m);
  Eigen::Index arc = 0;  // an arc runs from one under-crossing to the next
  for (const Visit& v : order) {
    if (v.over) {
      colours(v.crossing, arc) += 2.0;
      continue;
    }
    colours(v.crossing, arc) -= 1.0;
    arc = (arc + 1) % m;
    colours(v.crossing, arc) -= 1.0;
  }
  return static_cast<int>(std::lround(std::abs(colours.topLeftCorner(m - 1, m - 1).determinant())));
}

}  // namespace ligature::sim
