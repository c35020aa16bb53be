#pragma once
// Does an edge meet a triangle? The one question behind every move that keeps a knot.

#include <Eigen/Geometry>
#include <cmath>

namespace ligature::knot {

using Point = Eigen::Vector3d;

/// A triangle that a corner would sweep. What rounding cannot tell counts as a hit, which is the safe side: the
/// triangle is taken a little larger than it is, and an edge's end that may lie in its plane is asked for itself. In a
/// triangle of three corners almost on a line the normal's direction is uncertain, so this is no rare case.
struct Triangle {
  Triangle(const Point& a_, const Point& b_, const Point& c_) : a(a_), b(b_), c(c_), normal((b - a).cross(c - a)) {
    constexpr double kMargin = 1e-9, kRounding = 4e-16, kReach = 50.0;  // everything lies within 50 of the unit cube
    const double rounding = kRounding * (b - a).norm() * (c - a).norm();
    doubt_ = rounding * kReach;
    slack_ = -kMargin * normal.squaredNorm() - rounding * normal.norm();
  }

  /// On which side of the plane, and how far, times |normal|.
  [[nodiscard]] double height(const Point& p) const { return normal.dot(p - a); }

  /// Is it met by the edge p-q, whose ends have heights dp and dq?
  [[nodiscard]] bool is_met(const Point& p, const Point& q, double dp, double dq) const {
    if ((dp > 0.0) != (dq > 0.0) && holds(p + (q - p) * (dp / (dp - dq)))) return true;
    return (std::abs(dp) < doubt_ && holds(p)) || (std::abs(dq) < doubt_ && holds(q));
  }

  Point a, b, c, normal;

 private:
  /// Whether a point of the plane is inside.
  [[nodiscard]] bool holds(const Point& s) const {
    return normal.dot((b - a).cross(s - a)) >= slack_ && normal.dot((c - b).cross(s - b)) >= slack_ &&
           normal.dot((a - c).cross(s - c)) >= slack_;
  }

  double doubt_, slack_;
};

}  // namespace ligature::knot
