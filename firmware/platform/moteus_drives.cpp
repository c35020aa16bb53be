#include "firmware/platform/moteus_drives.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "firmware/platform/moteus_time.hpp"

namespace ligature::platform {
namespace {

using moteus::Mode;
using std::chrono::milliseconds;
constexpr Nanoseconds kPeriod = rt::kPeriod;
constexpr Nanoseconds kPatience =
    milliseconds(500);  // for an answer that shows that a drive is there, and for switching on
constexpr Nanoseconds kListening = milliseconds(60);
constexpr Nanoseconds kOnTheWay = milliseconds(2);  // longest time of a frame in the queues and on the bus
constexpr Nanoseconds kObey = milliseconds(100);    // for the answer that a drive is off
constexpr int kSets = 10;                           // a module that counts by itself is right now and again
constexpr const char* kNoButtons =
    "the button module does not answer each query to node 3 in time with frame 0x400: 2 bytes, the second one the "
    "register that was asked for; or an interface delays all frames (docs/drives.md)";

std::string told_of(rt::Foreign foreign) {
  constexpr const char* kNames[] = {"nothing", "torques or other commands", "queries", "stops", "diagnostic texts"};
  return std::string("another controller is on this bus: it sends ") + kNames[static_cast<std::size_t>(foreign)] +
         "; remedy: end or unplug it, a bus has one";
}

bool is_off(const MoteusLink::Node& node) { return node.is_off; }

}  // namespace

std::vector<std::string> moteus_lacks() {
  return {
      "what a drive does after its watchdog is not checked: servo.timeout_mode says whether it lets go (0), damps the "
      "motion (12), holds its position (10) or brakes (15) until it is told to stop",
      "calibration and position offset cannot be compared with the record: they are as somebody has set them"};
}

rt::BusTime MoteusDrives::bus_time() const noexcept { return moteus_time(); }

std::vector<can::Frame> MoteusDrives::example_samples() const {
  std::vector<can::Frame> frames;
  for (unsigned node = 1; node <= rt::kJoints; ++node)
    frames.push_back({node << 8U,
                      moteus::kReplyBytes,
                      {0x21, 0, 0, 0x2D, 1, 0, 0, 0, 0, 0x2D, 3, 0, 0, 0, 0, 0x21, 0x0F, 0, 0x2D, 0x0C},
                      can::Format::kFdFast});
  frames.push_back({moteus::kButtonsId, ButtonModule::kBytes, {}});
  return frames;
}

/// Runs periods as the loop does, until the condition holds after one of them. Without a request nothing is written. On
/// a lost bus it goes on, because the bus may take the frames again. @return false if it did not hold in time
template <class Condition>
bool MoteusDrives::run(BusWait& wait, Nanoseconds at_most, std::optional<rt::DriveRequest> request,
                       Condition condition) {
  const Nanoseconds deadline = wait.now() + at_most;
  while (wait.now() < deadline) {
    const Nanoseconds next = wait.now() + kPeriod;
    link_.request();
    while (wait.wait(next)) link_.drain();
    link_.drain();
    if (request) link_.write({{}, *request});
    if (condition()) return true;
  }
  return false;
}

std::optional<std::string> MoteusDrives::bus_complaint() const {
  if (link_.foreign() != rt::Foreign::kNone) return told_of(link_.foreign());
  if (bus_.is_lost()) return "the bus is lost";
  return std::nullopt;
}

/// Waits until `is_good` holds for every drive. @return the complaint about the first one for which it does not
template <class Condition>
std::optional<std::string> MoteusDrives::expect(BusWait& wait, std::optional<rt::DriveRequest> request,
                                                Condition is_good, const std::string& complaint) {
  const auto& nodes = link_.nodes();
  (void)run(wait, kPatience, request,
            [&] { return link_.foreign() != rt::Foreign::kNone || std::ranges::all_of(nodes, is_good); });
  if (auto e = bus_complaint()) return e;
  const auto bad = std::ranges::find_if_not(nodes, is_good);
  if (bad == nodes.end()) return std::nullopt;
  return name_of(*bad) + complaint;
}

std::string MoteusDrives::name_of(const Node& node) const {
  char state[48] = "";
  if (node.last) std::snprintf(state, sizeof state, " (mode %d, fault %d)", node.last->mode, node.last->fault);
  return "node " + std::to_string(&node - link_.nodes().data() + 1) + state + ": ";
}

std::optional<std::string> MoteusDrives::other_controller(BusWait& wait) {
  const Nanoseconds end = wait.now() + kListening;
  while (wait.wait(end)) link_.drain();
  link_.drain();
  if (link_.foreign() == rt::Foreign::kNone) return std::nullopt;
  return told_of(link_.foreign());
}

/// However it ends, the drives are told to stop at once, and must say that they have.
std::optional<std::string> MoteusDrives::configure(BusWait& wait) {
  const auto refusal = set_up(wait);
  auto still_on = switch_off(wait);
  if (!refusal) return still_on;
  return still_on ? *refusal + "; " + *still_on : refusal;
}

std::optional<std::string> MoteusDrives::set_up(BusWait& wait) {
  using rt::DriveRequest;
  if (auto e = expect(
          wait, DriveRequest::kHold, [](const Node& node) { return node.last.has_value(); },
          "no answer to a query; remedy: id 1 to 3, CAN-FD with 1 and 5 Mbit/s, firmware that knows the registers of "
          "docs/drives.md"))
    return e;
  if (auto e = expect(wait, DriveRequest::kHold, is_off, "does not say that it has stopped")) return e;
  if (auto e = expect(
          wait, DriveRequest::kHold, [](const Node& node) { return std::isfinite(node.last->position_rev); },
          "its position is no number"))
    return e;
  int sets = 0;
  if (!run(wait, kPatience, DriveRequest::kHold, [&] {
        sets += link_.reading().age_ticks == 0 ? 1 : 0;
        return sets >= kSets;
      }))
    return bus_complaint().value_or(kNoButtons);
  if (auto e = expect(
          wait, DriveRequest::kHold, [](const Node& node) { return node.home && *node.home != moteus::kHomeUnknown; },
          "its position counts from power-on (home state 0): it needs an absolute encoder"))
    return e;
  return try_watchdog(wait);
}

/// The drives must switch on, tell back their settings, stay on while they get what they get in operation, and be in
/// the mode "timeout" soon after they get nothing. Nobody asks in between: no frame may feed the watchdog.
std::optional<std::string> MoteusDrives::try_watchdog(BusWait& wait) {
  using rt::DriveRequest;
  const auto is_on = [](const Node& node) { return node.was_on && !node.has_failed; };
  const auto is_decided = [this] {
    return bus_complaint() || link_.is_on() || std::ranges::any_of(link_.nodes(), &Node::has_failed);
  };
  (void)run(wait, kPatience, DriveRequest::kEnable, is_decided);
  if (!link_.is_on()) {
    if (auto e = bus_complaint()) return e;
    const auto bad = std::ranges::find_if_not(link_.nodes(), is_on);
    if (bad != link_.nodes().end())
      return name_of(*bad) + "does not switch on and stay so, with the settings that it is told";
    return "the drives do not tell back the settings that they are told";
  }
  const Nanoseconds longer = watchdog_ + 10 * kPeriod;
  if (run(wait, longer, DriveRequest::kEnable, [this] { return !link_.is_on() || bus_complaint(); })) {
    if (auto e = bus_complaint()) return e;
    const auto bad = std::ranges::find_if_not(link_.nodes(), is_on);
    return (bad == link_.nodes().end() ? "" : name_of(*bad)) + "does not stay on while it gets torques of zero";
  }
  const Nanoseconds end = wait.now() + watchdog_ + kOnTheWay;
  while (wait.wait(end)) link_.drain();
  // One period for the answers, and three more if one is late
  (void)run(wait, 4 * kPeriod, std::nullopt, [this] { return link_.is_settled(); });
  if (auto e = bus_complaint()) return e;
  const auto has_timed_out = [](const Node& node) { return moteus::is(node.last->mode, Mode::kTimeout); };
  const auto bad = std::ranges::find_if_not(link_.nodes(), has_timed_out);
  if (bad == link_.nodes().end()) return std::nullopt;
  return name_of(*bad) + "no watchdog of " + std::to_string(watchdog_ / milliseconds(1)) +
         " ms: it is not in the mode 11 after so long a silence";
}

/// Stop, at once and again in each period, until all drives have said so in the answer to a later query.
std::optional<std::string> MoteusDrives::switch_off(BusWait& wait) {
  link_.forget_off();
  link_.write({{}, rt::DriveRequest::kHold});
  const auto& nodes = link_.nodes();
  if (run(wait, kObey, rt::DriveRequest::kHold, [&] { return std::ranges::all_of(nodes, is_off); }))
    return std::nullopt;
  if (bus_.is_lost()) return "the bus is lost: cut the drives' power";
  std::string text;
  for (const Node& node : nodes)
    if (!node.is_off) text += (text.empty() ? "" : "; ") + name_of(node) + "does not say that it is off: cut its power";
  return text;
}

}  // namespace ligature::platform
