#include "firmware/physics/paper/grasp.hpp"

#include "firmware/physics/nearest_beside.hpp"

namespace ligature::physics {
namespace {

V3<double> to_v3(const Vec3& a) noexcept { return {a.x(), a.y(), a.z()}; }
Vec3 to_vec3(const V3<double>& a) noexcept { return {a.x, a.y, a.z}; }

}  // namespace

void Grasp::close(std::size_t h, const ToolInput& tool, const ThreadModel& m, const ThreadState& s) noexcept {
  const V3<double> hand = to_v3(tool.p_WT);
  double nearest2 = std::numeric_limits<double>::infinity();
  int node = -1;
  for (int i = 0; i < m.nodes; ++i) {
    if (m.free[i] == 0.0 || i == node_[1 - h]) continue;
    const V3<double> apart = s.p.at(i) - hand;
    const double d2 = dot(apart, apart);
    if (d2 < nearest2) nearest2 = d2, node = i;
  }
  if (node < 0) return;
  const auto position = [&](int i) { return s.p.at(i); };
  const double off_m = norm(nearest_beside(node, m.nodes, position, hand).x - hand);
  if (off_m > reach_m_) return;
  node_[h] = node;
  // If the thread is already between the jaws, it is held at once, although the held node may be half a segment away
  if (off_m > m.radius_m) closing_[h].start(to_vec3(s.p.at(node)) - tool.p_WT, to_vec3(s.v.at(node)) - tool.v_WT);
}

void Grasp::update(const std::array<ToolInput, 2>& tools, const ThreadModel& m, const ThreadState& s) noexcept {
  for (std::size_t h = 0; h < 2; ++h) {
    const bool closes = tools[h].grip && !closed_[h];
    closed_[h] = tools[h].grip;
    if (closes) close(h, tools[h], m, s);
    if (closed_[h]) continue;
    node_[h] = -1;
    closing_[h].forget();
  }
}

}  // namespace ligature::physics
