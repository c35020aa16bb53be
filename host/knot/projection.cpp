#include "host/knot/projection.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "host/knot/closure.hpp"

namespace ligature::knot {
namespace {

struct Meeting {
  double at;  ///< edge index + fraction along the edge
  Pass pass;
};

double cross(const Point& a, const Point& b) { return a.x() * b.y() - a.y() * b.x(); }

enum class Meet { kApart, kCross, kDegenerate };

/// Where two projected edges cross: p + s d and q + t e, 0 < s, t < 1. z is the height above the plane of projection;
/// `above` is the height of the first edge over the second one at the crossing. kDegenerate: rounding could move the
/// crossing past the end of an edge or swap over and under, as is common for nearly parallel edges.
Meet meet(const Point& p, const Point& d, const Point& q, const Point& e, double& s, double& t, double& above) {
  constexpr double kEdge = 1e-9, kRounding = 1e-15;
  const Point pq = q - p;
  const double det = cross(d, e);
  const double d_long = std::hypot(d.x(), d.y()), e_long = std::hypot(e.x(), e.y()), apart = std::hypot(pq.x(), pq.y());
  if (std::abs(det) <= 1e-12 * d_long * e_long) {  // parallel: kApart, unless they lie on one line
    const double off = std::abs(cross(pq, d)), width = d_long * (apart + 1e-300);
    return off > 1e-9 * width ? Meet::kApart : Meet::kDegenerate;
  }
  s = cross(pq, e) / det;
  t = cross(pq, d) / det;
  const double s_edge = kEdge + kRounding * (apart + d_long) * e_long / std::abs(det);
  const double t_edge = kEdge + kRounding * (apart + e_long) * d_long / std::abs(det);
  const auto outside = [](double u, double edge) { return u < -edge || u > 1.0 + edge; };
  const auto inside = [](double u, double edge) { return u > edge && u < 1.0 - edge; };
  if (outside(s, s_edge) || outside(t, t_edge)) return Meet::kApart;
  above = s * d.z() - t * e.z() - pq.z();
  const bool is_sure = std::abs(above) > s_edge * std::abs(d.z()) + t_edge * std::abs(e.z()) + kRounding * pq.norm();
  return inside(s, s_edge) && inside(t, t_edge) && is_sure ? Meet::kCross : Meet::kDegenerate;
}

}  // namespace

std::optional<Diagram> project(std::span<const Point> corners, const Point& direction) {
  const std::size_t n = corners.size();
  const Point right = direction.unitOrthogonal(), up = direction.cross(right);
  std::vector<Point> flat(n), step(n);
  for (std::size_t i = 0; i < n; ++i) flat[i] = {right.dot(corners[i]), up.dot(corners[i]), direction.dot(corners[i])};
  for (std::size_t i = 0; i < n; ++i) step[i] = flat[(i + 1) % n] - flat[i];
  Diagram diagram;
  std::vector<Meeting> meetings;
  for (std::size_t i = 0; i + 2 < n; ++i) {
    for (std::size_t j = i + 2; j < n; ++j) {
      if (i == 0 && j + 1 == n) continue;  // the last edge is a neighbour of the first
      double s = 0.0, t = 0.0, above = 0.0;
      const Meet how = meet(flat[i], step[i], flat[j], step[j], s, t, above);
      if (how == Meet::kApart) continue;
      if (how == Meet::kDegenerate) return std::nullopt;
      const bool i_over = above > 0.0;
      const double turn = i_over ? cross(step[i], step[j]) : cross(step[j], step[i]);
      const std::size_t c = diagram.crossings();
      diagram.signs.push_back(turn > 0.0 ? 1 : -1);
      meetings.push_back({static_cast<double>(i) + s, {c, i_over}});
      meetings.push_back({static_cast<double>(j) + t, {c, !i_over}});
    }
  }
  std::sort(meetings.begin(), meetings.end(), [](const Meeting& a, const Meeting& b) { return a.at < b.at; });
  for (std::size_t k = 0; k < meetings.size(); ++k) {
    if (k > 0 && meetings[k].at - meetings[k - 1].at < 1e-12 * static_cast<double>(n))
      return std::nullopt;  // three strands meet in one point of the projection
    diagram.passes.push_back(meetings[k].pass);
  }
  return diagram;
}

std::optional<Diagram> simplest_view(std::span<const Point> corners, int views) {
  std::optional<Diagram> best;
  for (int k = 0; k < views; ++k) {
    auto diagram = project(corners, spread_direction(k, views));
    if (!diagram) continue;
    constexpr std::size_t kHopeless = 120;  // reduce() is O(n^3), and so large a diagram would not lead to a name
    if (diagram->crossings() <= kHopeless) reduce(*diagram);
    if (!best || diagram->crossings() < best->crossings()) best = std::move(diagram);
    if (best->crossings() < 3) break;  // fewer than three crossings: always the unknot
  }
  return best;
}

}  // namespace ligature::knot
