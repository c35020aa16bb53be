#include "firmware/platform/odrive_drives.hpp"

#include <cstdio>

#include "firmware/platform/foreign_frame.hpp"
#include "firmware/platform/odrive_time.hpp"

namespace ligature::platform {
namespace {

using std::chrono::milliseconds;
constexpr Nanoseconds kPeriod = rt::kPeriod;
constexpr Nanoseconds kPatience = milliseconds(500);  // for an answer
constexpr Nanoseconds kListening = milliseconds(60);

can::Frame idle(unsigned node) { return odrive::set_axis_state(node, odrive::kIdle); }
can::Frame closed_loop(unsigned node) { return odrive::set_axis_state(node, odrive::kClosedLoop); }
can::Frame no_torque(unsigned node) { return odrive::set_torque(node, 0.0F); }

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
  lines.emplace_back("mode, limits, gear and torque constant cannot be read back: they are as somebody has set them");
  return lines;
}

OdriveDrives::OdriveDrives(CanBus& bus, const device::Device& device)
    : profile_(device.odrive.value_or(device::OdriveProfile{})), bus_(bus), link_(bus, device) {}

rt::BusTime OdriveDrives::bus_time() const noexcept { return odrive_time(); }

std::vector<can::Frame> OdriveDrives::example_samples() const {
  std::vector<can::Frame> frames;
  for (unsigned node = 1; node <= rt::kJoints; ++node)
    frames.push_back({odrive::id_of(node, odrive::Command::kEstimates), odrive::kEstimatesBytes, {}});
  frames.push_back({profile_.buttons_id, odrive::kButtonsBytes, {}});
  return frames;
}

Nanoseconds OdriveDrives::beats(int count) const noexcept { return milliseconds(count * profile_.heartbeat_ms); }

void OdriveDrives::to_all(can::Frame (*frame)(unsigned node)) noexcept {
  for (unsigned node = 1; node <= rt::kJoints; ++node) link_.send(frame(node));
}

/// Waits until the condition holds; every millisecond it feeds the drives' watchdog with zero torque, or does not.
template <class Condition>
bool OdriveDrives::wait_until(BusWait& wait, Nanoseconds at_most, Feed feed, Condition condition) {
  const Nanoseconds deadline = wait.now() + at_most;
  do {
    if (feed == Feed::kTorque) to_all(no_torque);
    const Nanoseconds next = wait.now() + kPeriod;
    do {
      link_.drain();
      if (bus_.is_lost() || link_.foreign() != rt::Foreign::kNone) return false;
      if (condition()) return true;
    } while (wait.wait(next));
  } while (wait.now() < deadline);
  return false;
}

/// Waits until `is_good` holds for every drive. @return the complaint about the first one for which it does not
template <class Condition>
std::optional<std::string> OdriveDrives::expect(BusWait& wait, Nanoseconds at_most, Feed feed, Condition is_good,
                                                const std::string& complaint) {
  const auto bad = [&] {
    std::size_t joint = 0;
    while (joint < rt::kJoints && is_good(joint)) ++joint;
    return joint;
  };
  if (wait_until(wait, at_most, feed, [&] { return bad() == rt::kJoints; })) return std::nullopt;
  if (link_.foreign() != rt::Foreign::kNone) return told_of(link_.foreign());
  if (bus_.is_lost()) return "the bus takes no frames";
  const std::size_t joint = std::min(bad(), rt::kJoints - 1);
  const odrive::Heartbeat& beat = link_.nodes()[joint].heartbeat;
  char state[64];
  std::snprintf(state, sizeof state, " (state %d, error 0x%08X)", beat.state, beat.error);
  return "node " + std::to_string(joint + 1) + ": " + complaint + (link_.nodes()[joint].beats > 0 ? state : "");
}

std::optional<std::string> OdriveDrives::other_controller(BusWait& wait) {
  (void)wait_until(wait, kListening, Feed::kNothing, [] { return false; });
  if (link_.foreign() == rt::Foreign::kNone) return std::nullopt;
  return told_of(link_.foreign());
}

std::optional<std::string> OdriveDrives::configure(BusWait& wait) {
  const auto node = [this](std::size_t joint) -> const Node& { return link_.nodes()[joint]; };
  const auto is_heard = [&](std::size_t joint) { return node(joint).beats > 0; };
  if (auto e = expect(wait, kPatience + beats(2), Feed::kNothing, is_heard,
                      "no heartbeat; remedy: node id 1 to 3, 1 Mbit/s, heartbeat_msg_rate_ms = " +
                          std::to_string(profile_.heartbeat_ms)))
    return e;
  to_all(idle);
  to_all(odrive::clear_errors);
  to_all(odrive::set_torque_mode);
  const auto is_ready = [&](std::size_t joint) {
    return node(joint).heartbeat.state == odrive::kIdle && node(joint).heartbeat.error == 0;
  };
  if (auto e = expect(wait, kPatience + beats(2), Feed::kNothing, is_ready, "does not become idle without an error"))
    return e;
  link_.request();
  const auto answers = [&](std::size_t joint) { return (link_.arrived() >> joint & 1U) != 0; };
  if (auto e =
          expect(wait, kPatience, Feed::kNothing, answers, "no answer to the remote frame for its encoder estimates"))
    return e;
  if (!wait_until(wait, kPatience, Feed::kNothing, [this] { return link_.has_buttons(); }))
    return "the button module sends no frame " + std::to_string(profile_.buttons_id) +
           " of 2 bytes; allowed: at least one in 5 ms (docs/drives.md)";
  if (profile_.watchdog == device::DriveWatchdog::kNone) return std::nullopt;
  return try_watchdog(wait);
}

/// With zero torque: the drives must stay on while they get torque messages, and switch off when these stop.
std::optional<std::string> OdriveDrives::try_watchdog(BusWait& wait) {
  const auto node = [this](std::size_t joint) -> const Node& { return link_.nodes()[joint]; };
  const Nanoseconds watchdog = milliseconds(profile_.watchdog_ms);
  to_all(no_torque);
  to_all(closed_loop);
  const auto is_on = [&](std::size_t joint) { return node(joint).is_on() && node(joint).heartbeat.error == 0; };
  if (auto e = expect(wait, kPatience + beats(2), Feed::kTorque, is_on, "does not switch on")) return e;
  (void)wait_until(wait, 2 * watchdog + beats(1), Feed::kTorque, [] { return false; });
  if (auto e = expect(wait, Nanoseconds(0), Feed::kTorque, is_on, "switches off although torques come")) return e;
  const auto has_tripped = [&](std::size_t joint) {
    return !node(joint).is_on() && (node(joint).heartbeat.error & odrive::kWatchdogExpired) != 0;
  };
  auto missing = expect(wait, watchdog + beats(2) + kPatience, Feed::kNothing, has_tripped,
                        "no watchdog: it is still on, or off for another reason, " +
                            std::to_string(profile_.watchdog_ms + 2 * profile_.heartbeat_ms + 500) +
                            " ms after the last torque; remedy: enable_watchdog and watchdog_timeout = " +
                            std::to_string(1e-3 * profile_.watchdog_ms) + " in the drive (docs/drives.md)");
  to_all(idle);
  if (missing) return missing;
  to_all(odrive::clear_errors);
  const auto is_clear = [&](std::size_t joint) { return node(joint).heartbeat.error == 0; };
  return expect(wait, kPatience + beats(2), Feed::kNothing, is_clear, "keeps its error");
}

/// Power stages off. Their watchdogs watch only while they are on, so the silence to come is no fault.
void OdriveDrives::release(BusWait&) {
  to_all(no_torque);
  to_all(idle);
}

}  // namespace ligature::platform
