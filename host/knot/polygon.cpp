#include "host/knot/polygon.hpp"

#include <Eigen/Geometry>

namespace ligature::knot {
namespace {

/// Does the edge p-q, whose ends lie at heights dp and dq on different sides of the triangle's plane, meet it?
/// The triangle is taken a little larger than it is: a near miss counts as a hit, which is the safe side.
bool meets(const Point& p, const Point& q, double dp, double dq, const Point& a, const Point& b, const Point& c,
           const Point& normal) {
  constexpr double kMargin = 1e-9;
  const Point s = p + (q - p) * (dp / (dp - dq));
  const double slack = -kMargin * normal.squaredNorm();
  return normal.dot((b - a).cross(s - a)) >= slack && normal.dot((c - b).cross(s - b)) >= slack &&
         normal.dot((a - c).cross(s - c)) >= slack;
}

}  // namespace

Polygon::Polygon(std::vector<Point> corners) : corners_(std::move(corners)) {
  Point low = corners_.front(), high = low;
  for (const auto& p : corners_) low = low.cwiseMin(p), high = high.cwiseMax(p);
  const double step = 1e-9 * (high - low).norm();
  std::mt19937 random(1);
  std::uniform_real_distribution<double> jitter(-step, step);
  for (auto& p : corners_) p += Point(jitter(random), jitter(random), jitter(random));
}

bool Polygon::is_pierced(const Point& a, const Point& b, const Point& c, std::size_t first, std::size_t count) const {
  const Point normal = (b - a).cross(c - a);
  const std::size_t n = corners_.size();
  std::size_t k = first % n;
  double dp = normal.dot(corners_[k] - a);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t next = k + 1 == n ? 0 : k + 1;
    const double dq = normal.dot(corners_[next] - a);
    if ((dp > 0.0) != (dq > 0.0) && meets(corners_[k], corners_[next], dp, dq, a, b, c, normal)) return true;
    k = next;
    dp = dq;
  }
  return false;
}

void Polygon::cut_corners() {
  for (bool changed = true; changed && corners_.size() > 3;) {
    changed = false;
    for (std::size_t i = 0; i < corners_.size() && corners_.size() > 3;) {
      const std::size_t n = corners_.size();
      // The two edges that go, and the two that touch the triangle in its corners only, are not asked.
      const bool free = !is_pierced(corners_[(i + n - 1) % n], corners_[i], corners_[(i + 1) % n], i + 2, n - 4);
      if (free) {
        corners_.erase(corners_.begin() + static_cast<std::ptrdiff_t>(i));
        changed = true;
      } else {
        ++i;
      }
    }
  }
}

void Polygon::shake(std::mt19937& random) {
  const std::size_t n = corners_.size();
  if (n < 5) return;
  std::normal_distribution<double> normal;
  for (std::size_t i = 0; i < n; ++i) {
    const Point &a = corners_[(i + n - 1) % n], b = corners_[i], &c = corners_[(i + 1) % n];
    const double reach = 0.3 * (c - a).norm();
    const Point to = 0.5 * (a + c) + reach * Point(normal(random), normal(random), normal(random));
    // a-b sweeps (a, b, to), b-c sweeps (b, c, to); edges that share a corner with the one do not pierce it.
    if (!is_pierced(a, b, to, i + 1, n - 3) && !is_pierced(b, c, to, i + 2, n - 3)) corners_[i] = to;
  }
}

}  // namespace ligature::knot
