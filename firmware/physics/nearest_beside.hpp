#pragma once

#include <algorithm>

namespace ligature::physics {

/// A point x of the thread near a node: at the share `share` of the way from the node to its neighbour `next`.
template <class Vector>
struct Beside {
  int next = 0;
  double share = 0.0;
  Vector x{};
};

/// Point nearest to p on the two half segments next to a node: the piece of thread between the jaws of a gripper that
/// holds the node.
/// @param x function from a node's index to its position
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
