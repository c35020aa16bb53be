#include "firmware/telemetry/messages.hpp"

#include <algorithm>
#include <span>

namespace ligature::telemetry {
namespace {

template <std::size_t N>
void copy(const std::array<rt::Triple, N>& from, double (&to)[N][3]) {
  for (std::size_t h = 0; h < N; ++h) std::ranges::copy(from[h], to[h]);
}

// The record and the message name the same bits.
static_assert(rt::kPeriodLost == 1 && rt::kDeadlineMissed == 2 && rt::kContactCap == 64);

}  // namespace

ligature_msg::tick_t to_message(const rt::TickRecord& r) {
  ligature_msg::tick_t m{};
  m.tick = r.tick;
  m.scheduled_ns = r.scheduled_ns;
  m.wakeup_latency_ns = r.wakeup_latency_ns;
  m.sync_ns = r.sync_ns;
  m.tpdo_ns = r.tpdo_ns;
  m.law_ns = r.law_ns;
  m.control_ns = r.control_ns;
  m.execution_ns = r.execution_ns;
  m.flags = r.flags;
  m.state = r.state;
  m.fault = r.fault;
  copy(r.p_WT_m, m.p_WT_m);
  copy(r.v_WT_m_per_s, m.v_WT_m_per_s);
  copy(r.f_world_N, m.f_world_N);
  copy(r.f_device_N, m.f_device_N);
  for (std::size_t h = 0; h < rt::kHands; ++h) {
    std::ranges::copy(r.torque_permille[h], m.torque_permille[h]);
    m.grasped_node[h] = r.grasped_node[h];
    m.grip[h] = r.grip[h] ? 1 : 0;
    m.dead_man[h] = r.dead_man[h] ? 1 : 0;
    m.tpdo_age_ticks[h] = r.tpdo_age_ticks[h];
  }
  m.kinetic_J = r.kinetic_J;
  m.potential_J = r.potential_J;
  m.max_stretch = r.max_stretch;
  m.min_gap_m = r.min_gap_m;
  m.contacts = r.contacts;
  return m;
}

ligature_msg::thread_t to_message(const rt::ThreadSnapshot& s, double radius_m, std::int64_t utime) {
  ligature_msg::thread_t m{};
  m.utime = utime;
  m.tick = s.tick;
  m.radius_m = static_cast<float>(radius_m);
  m.count = s.count;
  for (const auto& p : std::span(s.p_W_m).first(static_cast<std::size_t>(s.count))) {
    m.p_W_m.push_back({p[0], p[1], p[2]});
  }
  std::ranges::copy(s.grasped_node, m.grasped_node);
  return m;
}

}  // namespace ligature::telemetry
