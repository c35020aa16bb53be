#pragma once
// A closed polygon in space and the moves that change its shape but never its knot.

#include <span>
#include <vector>

#include "host/knot/draw.hpp"
#include "host/knot/pierce.hpp"

namespace ligature::knot {

/// Moves each corner by up to 1e-7 of the line's extent, so that no four are coplanar and no three collinear; far below
/// what any thread of finite radius can feel.
void jitter(std::vector<Point>& line);

/// Triangle moves on a closed polygon [Koniaris & Muthukumar 1991; Taylor 2000]: a corner may go where the triangle
/// that it sweeps is pierced by no other edge, so every step is an ambient isotopy.
class Polygon {
 public:
  /// @param corners closed, the last joins the first; in general position, see jitter().
  explicit Polygon(std::vector<Point> corners) : corners_(std::move(corners)) {}

  /// Cuts corners off (a-b-c becomes a-c) until none can go.
  void cut_corners();

  /// Moves every corner somewhere near the middle of its neighbours, where that is free: gets cut_corners() unstuck.
  void shake(Draw& draw);

  [[nodiscard]] std::span<const Point> corners() const noexcept { return corners_; }

 private:
  /// Does one of the `count` edges that start at corners first, first + 1, .. (cyclic) pierce the triangle?
  [[nodiscard]] bool is_pierced(const Triangle& triangle, std::size_t first, std::size_t count) const;

  std::vector<Point> corners_;
};

}  // namespace ligature::knot
