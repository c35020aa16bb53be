#include "firmware/physics/grasp.hpp"

#include <algorithm>
#include <cmath>

namespace ligature::physics {
namespace {

V3<double> to_v3(const Vec3& a) noexcept { return {a.x(), a.y(), a.z()}; }
Vec3 to_vec3(const V3<double>& a) noexcept { return {a.x, a.y, a.z}; }

/// From p to the half segments beside a node, m.
double distance_m(const ThreadModel& m, const ThreadState& s, int node, const V3<double>& p) noexcept {
  const V3<double> off = p - s.p.at(node);
  double least2 = dot(off, off);
  for (const int next : {node - 1, node + 1}) {
    if (next < 0 || next >= m.nodes) continue;
    const V3<double> segment = s.p.at(next) - s.p.at(node);
    const double share = std::clamp(dot(off, segment) / std::max(dot(segment, segment), 1e-24), 0.0, 0.5);
    const V3<double> aside = off - share * segment;
    least2 = std::min(least2, dot(aside, aside));
  }
  return std::sqrt(least2);
}

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
  const double off_m = distance_m(m, s, node, hand);
  if (off_m > reach_m_) return;
  node_[h] = node;
  // What is between the jaws is held at once, though the node that stands for it is up to half a segment away.
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
