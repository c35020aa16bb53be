#include "host/knot/closure.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

namespace ligature::knot {
namespace {

Point centre_of(std::span<const Point> thread) {
  Point sum = Point::Zero();
  for (const auto& p : thread) sum += p;
  return sum / static_cast<double>(thread.size());
}

}  // namespace

Point outward(std::span<const Point> thread, const Point& from) {
  const Point d = from - centre_of(thread);
  const double length = d.norm();
  return length > 0.0 ? Point(d / length) : Point(Point::UnitZ());
}

Point spread_direction(int k, int n) {
  const double golden = std::numbers::pi * (3.0 - std::sqrt(5.0));
  const double z = 1.0 - (2.0 * k + 1.0) / n, r = std::sqrt(1.0 - z * z), angle = golden * k + 0.7;
  const Point p(r * std::cos(angle), r * std::sin(angle), z);
  return Eigen::AngleAxisd(0.9, Point(0.6, -0.48, 0.64)) * p;
}

std::vector<Point> way_home(std::span<const Point> thread, const Point& first, const Point& last) {
  const Point centre = centre_of(thread);
  double radius = 0.0;
  for (const auto& p : thread) radius = std::max(radius, (p - centre).norm());
  const double far = 20.0 * radius;
  const Point from = (thread.back() + far * last - centre).normalized(),
              to = (thread.front() + far * first - centre).normalized();
  // Axis of the great circle through `from` and `to`. When the two are opposite, many great circles pass through them;
  // then of any one.
  Point axis = from.cross(to);
  if (axis.norm() < 1e-6) axis = from.unitOrthogonal();
  const double angle = std::atan2(from.cross(to).norm(), from.dot(to));
  std::vector<Point> way;
  constexpr int kSteps = 4;  // chords of at most 45 degrees between points 20 thread radii out stay beyond 18 radii
  for (int k = 0; k <= kSteps; ++k) {
    const Point p = Eigen::AngleAxisd(angle * k / kSteps, axis.normalized()) * from;
    way.push_back(centre + far * p);
  }
  return way;
}

}  // namespace ligature::knot
