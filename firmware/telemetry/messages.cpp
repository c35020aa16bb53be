#include "firmware/telemetry/messages.hpp"

#include <algorithm>
#include <span>
#include <string>

namespace ligature::telemetry {
namespace {

template <std::size_t N>
void copy(const std::array<rt::Triple, N>& from, double (&to)[N][3]) {
  for (std::size_t h = 0; h < N; ++h) std::ranges::copy(from[h], to[h]);
}

// TickRecord and tick_t must use the same values.
static_assert(rt::kPeriodLost == 1 && rt::kDeadlineMissed == 2 && rt::kContactCap == 64);
static_assert(static_cast<int>(rt::kOverworked) == ligature_msg::tick_t::FLAG_OVERWORKED);
static_assert(static_cast<int>(rt::kThreadLate) == ligature_msg::tick_t::FLAG_THREAD_LATE);
static_assert(static_cast<int>(rt::kThreadCut) == ligature_msg::tick_t::FLAG_THREAD_CUT);
static_assert(rt::kPeakLimit == ligature_msg::tick_t::LIMIT_PEAK);
static_assert(rt::kTorqueLimit == ligature_msg::tick_t::LIMIT_TORQUE);
static_assert(static_cast<int>(rt::Propagation::kC) == ligature_msg::tick_t::PROPAGATION_C);
static_assert(static_cast<int>(rt::Degradation::kCandidates) == ligature_msg::tick_t::DEGRADED_CANDIDATES);

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
  copy(r.q_rad, m.q_rad);
  copy(r.f_wish_N, m.f_wish_N);
  std::ranges::copy(r.gain, m.gain);
  std::ranges::copy(r.port_energy_J, m.port_energy_J);
  std::ranges::copy(r.dissipated_J, m.dissipated_J);
  std::ranges::copy(r.injected_N_s_per_m, m.injected_N_s_per_m);
  std::ranges::copy(r.heat, m.heat);
  std::ranges::copy(r.limits, m.limits);
  std::ranges::copy(r.bus_load, m.bus_load);
  for (std::size_t h = 0; h < rt::kHands; ++h) {
    std::ranges::copy(r.torque_permille[h], m.torque_permille[h]);
    m.grasped_node[h] = r.grasped_node[h];
    m.propagation[h] = r.propagation[h];
    m.grip[h] = r.grip[h] ? 1 : 0;
    m.dead_man[h] = r.dead_man[h] ? 1 : 0;
    m.clutch[h] = r.clutch[h] ? 1 : 0;
    m.tpdo_age_ticks[h] = r.tpdo_age_ticks[h];
  }
  m.kinetic_J = r.kinetic_J;
  m.potential_J = r.potential_J;
  m.max_stretch = r.max_stretch;
  m.min_gap_m = r.min_gap_m;
  m.contacts = r.contacts;
  m.degradation = r.degradation;
  m.grasp_age_ticks = r.grasp_age_ticks;
  m.thread_start_ns = r.thread_start_ns;
  m.thread_done_ns = r.thread_done_ns;
  m.thread_work_ns = r.thread_work_ns;
  m.thread_end = r.thread_end;
  m.thread_cut_at = r.thread_cut_at;
  m.time_lost = r.time_lost;
  copy(r.tool_p_W_m, m.tool_p_W_m);
  copy(r.tool_v_W_m_per_s, m.tool_v_W_m_per_s);
  for (std::size_t h = 0; h < rt::kHands; ++h) m.tool_grip[h] = r.tool_grip[h] ? 1 : 0;
  m.thread_resets = r.thread_resets;
  m.thread_scenes = r.thread_scenes;
  m.thread_parameters = r.thread_parameters;
  m.thread_steps = r.thread_steps;
  std::ranges::copy(r.step_age_ticks, m.step_age_ticks);
  std::ranges::copy(r.step_cut_at, m.step_cut_at);
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
  m.tension_N.assign(s.tension_N.begin(), s.tension_N.begin() + s.count);
  m.turn_rad.assign(s.turn_rad.begin(), s.turn_rad.begin() + s.count);
  std::ranges::copy(s.grasped_node, m.grasped_node);
  return m;
}

namespace {

/// The generated decoder trusts a string's length field. It subtracts the final zero; for a length of INT_MIN this
/// overflows to 2 GB.
/// @return whether the length field of a command_t's text matches the size of the message
bool text_fits(std::span<const std::byte> message) {
  constexpr std::size_t kLength =
      // Offset of the text's length (4 bytes, big-endian): after hash, utime, id, session, challenge, kind
      8 + 8 + 8 + 8 + 8 + 1;
  constexpr std::size_t kRest = kLength + 4 + 8;  // length field and the final `value`
  if (message.size() <= kRest) return false;
  std::size_t length = 0;
  for (const auto byte : message.subspan(kLength, 4)) length = length << 8U | std::to_integer<std::size_t>(byte);
  return length == message.size() - kRest;  // at least 1: the final zero
}

}  // namespace

std::optional<ligature_msg::command_t> command_of(std::span<const std::byte> message) {
  constexpr std::size_t kLongest = 65'536;  // a scene or parameter name is far shorter
  if (message.size() > kLongest || !text_fits(message)) return std::nullopt;
  ligature_msg::command_t command{};
  const auto size = static_cast<int>(message.size());
  if (command.decode(message.data(), 0, size) != size) return std::nullopt;
  if (command.text.find('\0') != std::string::npos) return std::nullopt;
  return command;
}

}  // namespace ligature::telemetry
