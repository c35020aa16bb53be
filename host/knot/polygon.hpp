#pragma once
// A closed polygon in space and the moves that change its shape but never its knot.

#include <span>
#include <vector>

#include "host/knot/draw.hpp"
#include "host/knot/pierce.hpp"

namespace ligature::knot {

/// Moves each corner by up to 1e-7 of the line's extent, so that no four are coplanar and no three collinear. The move
/// is far smaller than any thread's radius.
void jitter(std::vector<Point>& line);

/// Triangle moves on a closed polygon [Koniaris & Muthukumar 1991; Taylor 2000]. A corner may move if no other edge
/// pierces the triangle that it sweeps, so that every move is an ambient isotopy.
class Polygon {
 public:
  /// @param corners closed: the last joins the first. In general position, see jitter().
  explicit Polygon(std::vector<Point> corners) : corners_(std::move(corners)) {}

  /// Removes corners (a-b-c becomes a-c) until none is removable.
  void cut_corners();

  /// Moves each corner to a random place near the middle of its neighbours, where the move is allowed. Lets
  /// cut_corners() continue when it is stuck.
  void shake(Draw& draw);

  [[nodiscard]] std::span<const Point> corners() const noexcept { return corners_; }

 private:
  /// Whether one of the `count` edges that start at corners first, first + 1, .. (cyclic) pierces the triangle.
  [[nodiscard]] bool is_pierced(const Triangle& triangle, std::size_t first, std::size_t count) const;

  std::vector<Point> corners_;
};

}  // namespace ligature::knot
