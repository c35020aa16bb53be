#pragma once
// A closed polygon in space and the moves that change its shape but never its knot.

#include <Eigen/Core>
#include <random>
#include <span>
#include <vector>

namespace ligature::knot {

using Point = Eigen::Vector3d;

/// Triangle moves on a closed polygon [Koniaris & Muthukumar 1991; Taylor 2000]: a corner may go where the triangle
/// that it sweeps is pierced by no other edge, so every step is an ambient isotopy.
class Polygon {
 public:
  /// @param corners closed, the last joins the first; moved by up to 1e-9 of their extent, so that no four are coplanar
  ///                and no three collinear; far below what any thread of finite radius can feel.
  explicit Polygon(std::vector<Point> corners);

  /// Cuts corners off (a-b-c becomes a-c) until none can go. Cost O(n^2) a pass, a few passes.
  void cut_corners();

  /// Moves every corner somewhere near the middle of its neighbours, where that is free: gets cut_corners() unstuck.
  void shake(std::mt19937& random);

  [[nodiscard]] std::span<const Point> corners() const noexcept { return corners_; }

 private:
  /// Does one of the `count` edges that start at corners first, first + 1, .. (cyclic) pierce the triangle?
  [[nodiscard]] bool is_pierced(const Point& a, const Point& b, const Point& c, std::size_t first,
                                std::size_t count) const;

  std::vector<Point> corners_;
};

}  // namespace ligature::knot
