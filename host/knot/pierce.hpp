#pragma once
// Triangle-edge intersection test. A corner of a polygon may move without changing the knot if no other edge pierces
// the triangle that the corner sweeps.

#include <Eigen/Geometry>
#include <cmath>

namespace ligature::knot {

using Point = Eigen::Vector3d;

/// The triangle that a moving corner sweeps. The test is conservative: a result that is uncertain by rounding counts as
/// a hit. The triangle is enlarged slightly, and an edge's end point close to the plane is tested by itself. That case
/// is common: with three nearly collinear corners the direction of the normal is uncertain.
struct Triangle {
  Triangle(const Point& a_, const Point& b_, const Point& c_) : a(a_), b(b_), c(c_), normal((b - a).cross(c - a)) {
    // kReach: all coordinates are below 50 (the thread fits the unit cube; its closure reaches further)
    constexpr double kMargin = 1e-9, kRounding = 4e-16, kReach = 50.0;
    const double rounding = kRounding * (b - a).norm() * (c - a).norm();
    doubt_ = rounding * kReach;
    slack_ = -kMargin * normal.squaredNorm() - rounding * normal.norm();
  }

  /// Signed distance from the plane, times |normal|.
  [[nodiscard]] double height(const Point& p) const { return normal.dot(p - a); }

  /// Whether the edge p-q meets the triangle; dp and dq are the heights of p and q.
  [[nodiscard]] bool is_met(const Point& p, const Point& q, double dp, double dq) const {
    if ((dp > 0.0) != (dq > 0.0) && holds(p + (q - p) * (dp / (dp - dq)))) return true;
    return (std::abs(dp) < doubt_ && holds(p)) || (std::abs(dq) < doubt_ && holds(q));
  }

  Point a, b, c, normal;

 private:
  /// Whether a point of the triangle's plane lies inside the (enlarged) triangle.
  [[nodiscard]] bool holds(const Point& s) const {
    return normal.dot((b - a).cross(s - a)) >= slack_ && normal.dot((c - b).cross(s - b)) >= slack_ &&
           normal.dot((a - c).cross(s - c)) >= slack_;
  }

  double doubt_, slack_;
};

}  // namespace ligature::knot
