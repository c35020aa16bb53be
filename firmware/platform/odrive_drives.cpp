#include "firmware/platform/odrive_drives.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <functional>
#include <numbers>

#include "firmware/platform/odrive_time.hpp"

namespace ligature::platform {
namespace {

using std::chrono::milliseconds;
constexpr Nanoseconds kPeriod = rt::kPeriod;
constexpr Nanoseconds kPatience = milliseconds(500);  // for an answer that shows that a drive is there
constexpr Nanoseconds kListening = milliseconds(60);
constexpr Nanoseconds kOnTheWay = milliseconds(2);  // longest time of a frame in the queues and on the bus
constexpr int kTrialPermille = 2;                   // of the rated torque, far too little to be felt
constexpr const char* kStaysOn = " does not say that it is off: cut its power";
constexpr int kMoreAnswers = 4;
constexpr float kEqual = 0.01F;  // share of a torque
constexpr float kAside_rev = 0.002F,
                kAside_rev_per_s = 0.05F;  // a drive that holds a position makes some 15 mN m for it

can::Frame idle(unsigned node) { return odrive::set_axis_state(node, odrive::kIdle); }
can::Frame closed_loop(unsigned node) { return odrive::set_axis_state(node, odrive::kClosedLoop); }

std::string told_of(rt::Foreign foreign) {
  constexpr const char* kNames[] = {"nothing", "torques or other setpoints", "remote frames", "states",
                                    "settings or parameters"};
  return std::string("another controller is on this bus: it sends ") + kNames[static_cast<std::size_t>(foreign)] +
         "; remedy: end or unplug it, a bus has one";
}

}  // namespace

std::vector<std::string> odrive_lacks(const device::OdriveProfile& p) {
  std::vector<std::string> lines;
  if (p.watchdog == device::DriveWatchdog::kNone)
    lines.emplace_back("no watchdog: if the controller falls silent, the last torque acts until the power is cut");
  lines.emplace_back("no report of the torque: one that nobody commanded shows only in the motion (no fault 26)");
  lines.push_back("a drive's fault is told by its heartbeat only, up to " + std::to_string(p.heartbeat_ms) +
                  " ms later");
  lines.emplace_back(
      "limits, torque constant and encoder offset cannot be read back: they are as somebody has set them");
  return lines;
}

OdriveDrives::OdriveDrives(CanBus& bus, const device::Device& device, int watchdog_ms)
    : profile_(device.odrive.value_or(device::OdriveProfile{})),
      watchdog_ms_(watchdog_ms),
      bus_(bus),
      trial_torque_Nm_(static_cast<float>(kTrialPermille * device.Nm_per_permille())),
      link_(bus, device) {}

rt::BusTime OdriveDrives::bus_time() const noexcept { return odrive_time(); }

std::vector<can::Frame> OdriveDrives::example_samples() const {
  std::vector<can::Frame> frames;
  for (unsigned node = 1; node <= rt::kJoints; ++node)
    frames.push_back({odrive::id_of(node, odrive::Command::kEstimates), odrive::kWordBytes, {}});
  frames.push_back({profile_.buttons_id, ButtonModule::kBytes, {}});
  return frames;
}

Nanoseconds OdriveDrives::beats(int count) const noexcept { return milliseconds(count * profile_.heartbeat_ms); }

template <class MakeFrame>
void OdriveDrives::to_all(MakeFrame make_frame) noexcept {
  for (unsigned node = 1; node <= rt::kJoints; ++node) link_.send(make_frame(node));
}

void OdriveDrives::send_traffic(const Traffic& traffic) noexcept {
  if (traffic.torque_Nm) to_all([&](unsigned node) { return odrive::set_torque(node, *traffic.torque_Nm); });
  if (traffic.requests) link_.request();
  if (traffic.targets) to_all([](unsigned node) { return odrive::ask(node, odrive::Command::kGetTorques); });
}

/// One period, so that no more frames wait than a period of the loop has: Linux' queue of a CAN interface takes ten.
void OdriveDrives::pause(BusWait& wait) {
  (void)wait_until(wait, kPeriod, {}, [] { return false; });
}

/// Waits until the condition holds, and sends the traffic in each period. @return false also if it held too late, if a
/// frame was refused, or if another controller was heard
template <class Condition>
bool OdriveDrives::wait_until(BusWait& wait, Nanoseconds at_most, const Traffic& traffic, Condition condition) {
  const Nanoseconds deadline = wait.now() + at_most;
  do {
    send_traffic(traffic);
    const Nanoseconds next = wait.now() + kPeriod;
    do {
      link_.drain();
      if (bus_.is_lost() || link_.has_refused() || link_.foreign() != rt::Foreign::kNone) return false;
      if (condition()) return wait.now() <= deadline;
    } while (wait.wait(next));
  } while (wait.now() < deadline);
  return false;
}

std::optional<std::string> OdriveDrives::bus_complaint() const {
  if (link_.foreign() != rt::Foreign::kNone) return told_of(link_.foreign());
  if (bus_.is_lost() || link_.has_refused()) return kTakesNoFrames;
  return std::nullopt;
}

/// Waits until `is_good` holds for every drive. @return the complaint about the first one for which it does not
template <class Condition>
std::optional<std::string> OdriveDrives::expect(BusWait& wait, Nanoseconds at_most, const Traffic& traffic,
                                                Condition is_good, const std::string& complaint) {
  const auto& nodes = link_.nodes();
  if (wait_until(wait, at_most, traffic, [&] { return std::ranges::all_of(nodes, is_good); })) return std::nullopt;
  if (auto e = bus_complaint()) return e;
  const auto bad = std::ranges::find_if_not(nodes, is_good);
  if (bad == nodes.end()) return complaint + " (a drive was late, or this machine)";
  char state[64] = "";
  if (bad->heartbeat.state != 0)
    std::snprintf(state, sizeof state, " (state %d, error 0x%08X)", bad->heartbeat.state, bad->heartbeat.error);
  return name_of(*bad) + complaint + state;
}

std::string OdriveDrives::name_of(const Node& node) const {
  return "node " + std::to_string(&node - link_.nodes().data() + 1) + ": ";
}

std::optional<std::string> OdriveDrives::other_controller(BusWait& wait) {
  (void)wait_until(wait, kListening, {}, [] { return false; });
  if (link_.foreign() == rt::Foreign::kNone) return std::nullopt;
  return told_of(link_.foreign());
}

/// However it ends, the power stages are off.
std::optional<std::string> OdriveDrives::configure(BusWait& wait) {
  auto refusal = set_up(wait);
  auto still_on = switch_off(wait);
  if (!refusal && link_.was_away()) refusal = "a drive's heartbeat stayed away for three of its periods";
  if (!refusal) return still_on;
  return still_on ? *refusal + "; " + *still_on : refusal;
}

std::optional<std::string> OdriveDrives::set_up(BusWait& wait) {
  if (profile_.watchdog != device::DriveWatchdog::kNone && profile_.watchdog_ms > watchdog_ms_)
    return "odrive.watchdog_ms is " + std::to_string(profile_.watchdog_ms) + ", allowed at most --watchdog-ms, " +
           std::to_string(watchdog_ms_);
  const auto is_heard = [](const Node& node) { return node.beats >= 3; };
  if (auto e = expect(wait, beats(4) + kOnTheWay, {}, is_heard,
                      "fewer than three heartbeats in the time of four; remedy: node id 1 to 3, 1 Mbit/s, "
                      "heartbeat_msg_rate_ms at most " +
                          std::to_string(profile_.heartbeat_ms)))
    return e;
  const auto only_answers = [&] {
    return expect(
        wait, kOnTheWay, {}, [](const Node& node) { return !node.tells_unasked; },
        "sends its position without being asked, so that the age of a sample is not known; remedy: "
        "encoder_msg_rate_ms = 0, and each node id once");
  };
  if (auto e = only_answers()) return e;
  to_all([](unsigned node) { return odrive::ask(node, odrive::Command::kGetVersion); });
  if (auto e = expect(
          wait, kPatience, {}, [](const Node& node) { return node.is_new; },
          "does not say that its software is 0.6 or newer"))
    return e;
  if (auto e = switch_off(wait)) return e;
  if (auto e = clear_errors(wait)) return e;
  const auto answers = [](const Node& node) { return node.answers; };
  const Traffic samples{.torque_Nm = 0.0F, .requests = true};
  if (auto e = expect(wait, kPatience, samples, answers, "no answer to the remote frame for its encoder estimates"))
    return e;
  if (!wait_until(wait, kPatience, samples, [this] { return link_.has_samples(); }))
    return bus_complaint().value_or("the button module does not answer the request to node 3 with frame " +
                                    std::to_string(profile_.buttons_id) +
                                    ": 2 bytes, with a counter that changes each time (docs/drives.md)");
  if (auto e = try_watchdog(wait)) return e;
  return only_answers();
}

/// The drives must aim at exactly the torque that they are told, several times in a row.
std::optional<std::string> OdriveDrives::try_torque(BusWait& wait, float torque_Nm) {
  const std::string complaint =
      "does not aim at the torque that it is told: it is not in torque mode, or adds something of its own";
  const Traffic traffic{.torque_Nm = torque_Nm, .targets = true};
  const auto follows = [&](const Node& node) {
    return node.target_Nm && std::abs(*node.target_Nm - torque_Nm) <= kEqual * trial_torque_Nm_;
  };
  const auto& nodes = link_.nodes();
  link_.forget_targets();
  if (auto e = expect(wait, beats(3), traffic, follows, complaint)) return e;
  for (int more = 0; more < kMoreAnswers; ++more) {
    link_.forget_targets();
    const auto tells = [](const Node& node) { return node.target_Nm.has_value(); };
    if (auto e = expect(wait, beats(3), traffic, tells, "does not tell the torque that it aims at")) return e;
    if (const auto bad = std::ranges::find_if_not(nodes, follows); bad != nodes.end()) return name_of(*bad) + complaint;
  }
  return std::nullopt;
}

/// A drive that holds a position or a speed aims at no torque while it rests there. So it is asked for another position
/// and speed, which in torque mode mean nothing.
std::optional<std::string> OdriveDrives::try_mode(BusWait& wait) {
  const auto reading = link_.reading();
  for (unsigned node = 1; node <= rt::kJoints; ++node) {
    const auto here_rev = static_cast<float>(reading.q_rad[node - 1] / (2.0 * std::numbers::pi));
    link_.send(odrive::set_position(node, here_rev + kAside_rev));
  }
  pause(wait);
  if (auto e = bus_complaint()) return e;
  to_all([](unsigned node) { return odrive::set_velocity(node, kAside_rev_per_s); });
  pause(wait);
  (void)wait_until(wait, kOnTheWay, {.torque_Nm = 0.0F}, [] { return false; });
  return try_torque(wait, 0.0F);
}

/// The drives must stay on while they get what they get in operation, and switch off in time when they get nothing:
/// that is what happens if the controller dies, and after a fault (OdriveLink::switch_off).
std::optional<std::string> OdriveDrives::try_watchdog(BusWait& wait) {
  const Nanoseconds watchdog = milliseconds(profile_.watchdog_ms);
  const Traffic as_in_operation{.torque_Nm = 0.0F, .requests = true}, silence{};
  to_all(odrive::set_torque_mode);
  pause(wait);
  for (std::size_t joint = 0; joint < rt::kJoints; ++joint) link_.send_limits(joint);
  pause(wait);
  send_traffic({.torque_Nm = 0.0F});
  for (unsigned node = 1; node <= rt::kJoints; ++node) {
    if (auto e = bus_complaint()) return e;  // never on without its mode and limits
    link_.send(closed_loop(node));
  }
  pause(wait);
  const auto is_on = [](const Node& node) { return node.is_on() && node.heartbeat.error == 0; };
  if (auto e = expect(wait, kPatience, as_in_operation, is_on, "does not switch on")) return e;
  pause(wait);  // a heartbeat ended the wait: the frames of this period may still be in the queue
  for (const float torque : {trial_torque_Nm_, -trial_torque_Nm_, 0.0F}) {
    if (auto e = try_torque(wait, torque)) return e;
  }
  if (auto e = try_mode(wait)) return e;
  if (profile_.watchdog == device::DriveWatchdog::kNone) return std::nullopt;
  (void)wait_until(wait, 2 * watchdog + beats(1), as_in_operation, [] { return false; });
  link_.forget_beats();
  const auto stays_on = [&](const Node& node) { return node.beats > 0 && is_on(node); };
  if (auto e = expect(wait, beats(2), as_in_operation, stays_on, "switches off although torques come")) return e;
  const auto has_tripped = [](const Node& node) {
    return !node.is_on() && (node.heartbeat.error & odrive::kWatchdogExpired) != 0;
  };
  if (auto e = expect(wait, watchdog + beats(1) + kOnTheWay, silence, has_tripped,
                      "no watchdog of " + std::to_string(profile_.watchdog_ms) +
                          " ms: it is still on, or off for another reason; remedy: enable_watchdog and watchdog_timeout"
                          " = " +
                          std::to_string(1e-3 * profile_.watchdog_ms) + " in the drive"))
    return e;
  return clear_errors(wait);
}

/// Zero torques feed a watchdog that also runs while the drive is off, so that its error does not come back.
std::optional<std::string> OdriveDrives::clear_errors(BusWait& wait) {
  to_all(odrive::clear_errors);
  link_.forget_beats();
  const auto is_clear = [](const Node& node) { return node.beats >= 2 && node.heartbeat.error == 0; };
  return expect(wait, beats(3) + kOnTheWay, {.torque_Nm = 0.0F}, is_clear, "keeps its error");
}

/// Idle to all drives; to those for which the bus refused it, again in each period: its queue gets room, and a bus that
/// was lost may come back (an interface that was down). @return whether all were sent
bool OdriveDrives::send_idle(BusWait& wait) {
  const Nanoseconds deadline = wait.now() + kPatience;
  std::array<bool, rt::kJoints> is_sent{};
  do {
    for (unsigned node = 1; node <= rt::kJoints; ++node) {
      if (!is_sent[node - 1]) is_sent[node - 1] = link_.send(idle(node));
    }
    if (std::ranges::all_of(is_sent, std::identity{})) return true;
    const Nanoseconds next = wait.now() + kPeriod;
    while (wait.wait(next)) link_.drain();
  } while (wait.now() < deadline);
  return false;
}

/// Zero torque, then idle, then silence until the drives say that they are off: any frame could feed the watchdog of
/// one that does not obey. Once more after that. It goes on also if another controller is heard, the bus refuses frames
/// or is lost for a while.
std::optional<std::string> OdriveDrives::switch_off(BusWait& wait) {
  constexpr int kTimes = 2;
  const auto is_off = [](const Node& node) { return node.beats >= 2 && node.heartbeat.state == odrive::kIdle; };
  send_traffic({.torque_Nm = 0.0F});
  for (int times = 0; times < kTimes && send_idle(wait); ++times) {
    link_.forget_beats();
    const Nanoseconds deadline = wait.now() + milliseconds(profile_.watchdog_ms) + beats(3) + kOnTheWay;
    do {
      link_.drain();
      if (std::ranges::all_of(link_.nodes(), is_off)) return std::nullopt;
    } while (wait.wait(deadline));
  }
  if (bus_.is_lost()) return "the bus is lost: cut the drives' power";
  std::string text;
  for (std::size_t j = 0; j < rt::kJoints; ++j)
    if (!is_off(link_.nodes()[j])) text += (text.empty() ? "" : "; ") + ("node " + std::to_string(j + 1)) + kStaysOn;
  return text;
}

/// Power stages off. A watchdog that runs out in the silence to come finds nothing to switch off.
std::optional<std::string> OdriveDrives::release(BusWait& wait) { return switch_off(wait); }

}  // namespace ligature::platform
