#include "firmware/physics/grasp.hpp"

#include <limits>

namespace ligature::physics {

void Grasp::update(const std::array<ToolInput, 2>& tools, const ThreadModel& m, const ThreadState& s) noexcept {
  for (std::size_t h = 0; h < 2; ++h) {
    const bool closes = tools[h].grip && !closed_[h];
    closed_[h] = tools[h].grip;
    if (!closed_[h]) node_[h] = -1;
    if (!closes) continue;
    const V3<double> hand{tools[h].p_WT.x(), tools[h].p_WT.y(), tools[h].p_WT.z()};
    double nearest2 = std::numeric_limits<double>::infinity();
    for (int i = 0; i < m.nodes; ++i) {
      if (m.free[i] == 0.0 || i == node_[1 - h]) continue;
      const V3<double> apart = s.p.at(i) - hand;
      const double d2 = dot(apart, apart);
      if (d2 < nearest2) nearest2 = d2, node_[h] = i;
    }
  }
}

}  // namespace ligature::physics
