#pragma once

#include <algorithm>

namespace ligature::physics {

/// A point of the thread next to a node: at `share` of the way to the neighbour `next`, position x.
template <class Vector>
struct Beside {
  int next = 0;
  double share = 0.0;
  Vector x{};
};

/// Point nearest to p on the two half segments next to a node: what is between the jaws of a gripper that holds it.
/// @param x  position of a node, x(int) -> Vector
template <class Vector, class Position>
[[nodiscard]] Beside<Vector> nearest_beside(int node, int nodes, const Position& x, const Vector& p) noexcept {
  Beside<Vector> nearest{node, 0.0, x(node)};
  double least = norm(p - nearest.x);
  for (const int next : {node - 1, node + 1}) {
    if (next < 0 || next >= nodes) continue;
    const Vector segment = x(next) - x(node);
    const double share = std::clamp(dot(p - x(node), segment) / std::max(dot(segment, segment), 1e-24), 0.0, 0.5);
    const Vector place = x(node) + share * segment;
    if (norm(p - place) < least) least = norm(p - place), nearest = {next, share, place};
  }
  return nearest;
}

}  // namespace ligature::physics
