#include "firmware/control/tick_report.hpp"

#include <algorithm>
#include <cmath>

namespace ligature::control {
namespace {

constexpr double kNoGap_m = 1e9;  // value for "nothing near" on the wire, since not every reader handles infinity

rt::Triple triple(const Vec3& v) noexcept { return {v.x(), v.y(), v.z()}; }

static_assert(static_cast<int>(physics::Propagation::kA) == static_cast<int>(rt::Propagation::kA) &&
              static_cast<int>(physics::Propagation::kB) == static_cast<int>(rt::Propagation::kB) &&
              static_cast<int>(physics::Propagation::kC) == static_cast<int>(rt::Propagation::kC));

rt::Degradation given_up(const physics::Diagnostics& thread) noexcept {
  switch (thread.degradation) {
    case physics::Degradation::kMotion:
      return rt::Degradation::kCandidates;
    case physics::Degradation::kContacts:
      return rt::Degradation::kContacts;
    case physics::Degradation::kIterations:
      return rt::Degradation::kIterations;
    case physics::Degradation::kNone:
      break;
  }
  return thread.contact_cap_hit ? rt::Degradation::kContacts : rt::Degradation::kNone;
}

}  // namespace

void report(const Controller& controller, rt::TickRecord& record) noexcept {
  record.state = static_cast<std::int8_t>(controller.state());
  record.fault = static_cast<std::int16_t>(controller.fault());
  record.armed = controller.armed();
  record.culprit = controller.culprit();
  const auto tools = controller.tools();
  for (std::size_t h = 0; h < rt::kHands; ++h) {
    report(controller.hand(h), h, record);
    report(tools[h], h, record);
  }
}

void report(const HandState& s, std::size_t h, rt::TickRecord& record) noexcept {
  record.p_WT_m[h] = triple(s.p_WT);
  record.v_WT_m_per_s[h] = triple(s.v_WT);
  record.f_device_N[h] = triple(s.f_device_N);
  record.q_rad[h] = s.q_rad;
  record.f_wish_N[h] = triple(s.f_wish_N);
  record.gain[h] = s.gain;
  record.port_energy_J[h] = s.port_energy_J;
  record.dissipated_J[h] = s.dissipated_J;
  record.injected_N_s_per_m[h] = s.injected_N_s_per_m;
  record.heat[h] = s.heat;
  record.limits[h] = s.limits;
  record.clutch[h] = s.clutch;
  record.bus_load[h] = s.bus_load;
  record.grip[h] = s.grip;
  record.dead_man[h] = s.dead_man;
  record.tpdo_age_ticks[h] = static_cast<std::int16_t>(std::min<std::int64_t>(s.age_ticks, INT16_MAX));
  if (s.age_ticks > 0) record.flags |= h == 0 ? rt::kLeftStale : rt::kRightStale;
  if (s.limited) record.flags |= h == 0 ? rt::kLeftLimited : rt::kRightLimited;
}

void report(const ThreadOrders& orders, rt::TickRecord& record) noexcept {
  record.thread_resets = static_cast<std::int32_t>(orders.resets);
  record.thread_scenes = static_cast<std::int32_t>(orders.scenes);
  record.thread_parameters = static_cast<std::int32_t>(orders.parameters);
}

void report(const physics::ToolInput& tool, std::size_t hand, rt::TickRecord& record) noexcept {
  record.tool_p_W_m[hand] = triple(tool.p_WT);
  record.tool_v_W_m_per_s[hand] = triple(tool.v_WT);
  record.tool_grip[hand] = tool.grip;
}

void report(const physics::Diagnostics& thread, rt::TickRecord& record) noexcept {
  record.kinetic_J = thread.kinetic_J;
  record.potential_J = thread.potential_J;
  record.max_stretch = thread.max_stretch;
  record.min_gap_m = std::isfinite(thread.min_gap_m) ? thread.min_gap_m : kNoGap_m;
  record.contacts = static_cast<std::int16_t>(std::min<int>(thread.contacts, INT16_MAX));
  if (thread.contact_cap_hit) record.flags |= rt::kContactCap;
  record.degradation = static_cast<std::int8_t>(given_up(thread));
  record.thread_end = static_cast<std::int8_t>(thread.end);
  record.thread_cut_at = thread.cut_at;
  record.time_lost = static_cast<float>(thread.time_lost);
}

void report(const physics::HandContact& contact, std::size_t hand, rt::TickRecord& record) noexcept {
  record.f_world_N[hand] = triple(contact.f_W);
  record.grasped_node[hand] = static_cast<std::int16_t>(contact.node);
  record.propagation[hand] = static_cast<std::int8_t>(contact.condition);
}

void report(std::span<const physics::Vec3> nodes_W, const ThreadResult& thread, rt::ThreadSnapshot& snapshot) noexcept {
  snapshot.tick = thread.tick;
  for (std::size_t h = 0; h < rt::kHands; ++h)
    snapshot.grasped_node[h] = static_cast<std::int16_t>(thread.hand[h].node);
  snapshot.count = static_cast<std::int32_t>(std::min(nodes_W.size(), rt::kMaxNodes));
  for (std::size_t i = 0; i < static_cast<std::size_t>(snapshot.count); ++i) {
    for (std::size_t a = 0; a < 3; ++a) {
      snapshot.p_W_m[i][a] = static_cast<float>(nodes_W[i][static_cast<Eigen::Index>(a)]);
    }
  }
}

void report(const physics::Simulation& thread, const ThreadResult& result, rt::ThreadSnapshot& snapshot) noexcept {
  report(thread.nodes_W(), result, snapshot);
  const auto count = static_cast<std::size_t>(snapshot.count);
  thread.describe(std::span(snapshot.tension_N).first(count), std::span(snapshot.turn_rad).first(count));
}

}  // namespace ligature::control
