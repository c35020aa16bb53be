#include "host/knot/polygon.hpp"

#include "host/knot/corner_cutter.hpp"

namespace ligature::knot {
void jitter(std::vector<Point>& line) {
  Point low = line.front(), high = low;
  for (const auto& p : line) low = low.cwiseMin(p), high = high.cwiseMax(p);
  const double step = 1e-7 * (high - low).norm();
  Draw draw(1);
  for (auto& p : line)
    for (Eigen::Index i = 0; i < 3; ++i) p[i] += step * (2.0 * draw.share() - 1.0);
}

bool Polygon::is_pierced(const Triangle& triangle, std::size_t first, std::size_t count) const {
  const std::size_t n = corners_.size();
  std::size_t k = first % n;
  double from = triangle.height(corners_[k]);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t next = k + 1 == n ? 0 : k + 1;
    const double to = triangle.height(corners_[next]);
    if (triangle.is_met(corners_[k], corners_[next], from, to)) return true;
    k = next;
    from = to;
  }
  return false;
}

void Polygon::cut_corners() { corners_ = with_corners_cut(std::move(corners_), true); }

void Polygon::shake(Draw& draw) {
  const std::size_t n = corners_.size();
  if (n < 5) return;
  for (std::size_t i = 0; i < n; ++i) {
    const Point &a = corners_[(i + n - 1) % n], b = corners_[i], &c = corners_[(i + 1) % n];
    const double reach = 0.3 * (c - a).norm();
    const Point away{draw.bell(), draw.bell(), draw.bell()};  // braces guarantee the order of evaluation
    const Point to = 0.5 * (a + c) + reach * away;
    // b moves to `to`: a-b sweeps (a, b, to), b-c sweeps (b, c, to). Edges that share a corner with the swept triangle
    // are not tested.
    if (!is_pierced({a, b, to}, i + 1, n - 3) && !is_pierced({b, c, to}, i + 2, n - 3)) corners_[i] = to;
  }
}

}  // namespace ligature::knot
