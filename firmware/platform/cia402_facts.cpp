#include "firmware/platform/cia402_facts.hpp"

#include <algorithm>
#include <cmath>

namespace ligature::platform {
namespace {

constexpr can::Object object_of(const device::ObjectAddress& o) noexcept { return {o.index, o.sub}; }

constexpr can::Watchdog watchdog_of(device::DriveWatchdog w) noexcept {
  switch (w) {
    case device::DriveWatchdog::kRpdoTimer:
      return can::Watchdog::kRpdoTimer;
    case device::DriveWatchdog::kHeartbeat:
      return can::Watchdog::kHeartbeat;
    case device::DriveWatchdog::kNone:
      break;
  }
  return can::Watchdog::kNone;
}

}  // namespace

can::DriveFacts drive_facts(const device::Device& d) noexcept {
  const device::Cia402Profile& p = d.cia402;
  const double gear = p.at_motor ? d.gear : 1.0;
  can::DriveFacts facts;
  facts.rated_torque_object = object_of(p.rated_torque);
  facts.counts_object = object_of(p.counts);
  facts.max_torque_object = object_of(p.max_torque);
  facts.rated_torque = static_cast<std::uint32_t>(std::lround(d.rated_torque_Nm / gear / p.rated_torque_unit_Nm));
  facts.counts = static_cast<std::uint32_t>(std::lround(d.counts_per_revolution() / gear / p.counts_unit));
  facts.max_torque_permille = static_cast<std::uint16_t>(d.max_torque_permille);
  facts.buttons = {can::NodeId{static_cast<std::uint8_t>(p.buttons.node)}, object_of(p.buttons.object),
                   static_cast<std::uint8_t>(p.buttons.bits), p.buttons.are_inputs()};
  facts.pdos = static_cast<std::uint8_t>(p.pdos);
  facts.watchdog = watchdog_of(p.watchdog);
  for (std::size_t i = 0; i < std::min(p.writes.size(), facts.writes.size()); ++i)
    facts.writes[i] = {object_of(p.writes[i].object), p.writes[i].value, static_cast<std::uint8_t>(p.writes[i].bytes)};
  for (std::size_t i = 0; i < std::min(p.optional.size(), facts.optional.size()); ++i)
    facts.optional[i] = object_of(p.optional[i]);
  return facts;
}

can::StartupTimes startup_times(const device::Device& d, int watchdog_ms) noexcept {
  can::StartupTimes times;
  times.drive = drive_facts(d);
  const auto own_ms = static_cast<std::uint16_t>(std::max(watchdog_ms, d.cia402.watchdog_ms));
  times.rpdo_timeout_ms = own_ms;
  const bool only = d.cia402.watchdog == device::DriveWatchdog::kHeartbeat;
  times.heartbeat_timeout_ms = only ? own_ms : std::max(times.heartbeat_timeout_ms, own_ms);
  return times;
}

int heartbeat_periods(const device::Device& d, int watchdog_ms) noexcept {
  constexpr int kUsual = can::profile::kDefaultHeartbeat_ms / 2;  // so that one may be lost
  if (d.cia402.watchdog != device::DriveWatchdog::kHeartbeat) return kUsual;
  return std::max(1, std::max(watchdog_ms, d.cia402.watchdog_ms) / 4);
}

std::vector<std::string> lacks_of(const device::Device& d, int watchdog_ms) {
  const device::Cia402Profile& p = d.cia402;
  std::vector<std::string> lines;
  if (p.watchdog == device::DriveWatchdog::kHeartbeat)
    lines.push_back(
        "no watchdog on torque messages: if only these stay away, the last torque acts on; if the controller "
        "falls silent, for up to " +
        std::to_string(std::max(watchdog_ms, p.watchdog_ms)) + " ms");
  if (p.watchdog == device::DriveWatchdog::kNone)
    lines.emplace_back("no watchdog: if the controller falls silent, the last torque acts until the power is cut");
  if (std::ranges::count(p.optional, device::ObjectAddress{0x6007, 0}) > 0)
    lines.emplace_back("0x6007:00 may be missing: NMT stop may then leave the last torque");
  if (std::ranges::count(p.optional, device::ObjectAddress{0x6061, 0}) > 0)
    lines.emplace_back("0x6061:00 may be missing: then nobody checks that the drive takes its target for a torque");
  if (p.buttons.are_inputs())
    lines.emplace_back(
        "no sign of life from the buttons: if they freeze while the dead-man is pressed, it stays pressed");
  if (!p.max_torque.is_there()) lines.emplace_back("no torque limit of its own: only the controller limits the torque");
  if (!p.counts.is_there()) lines.emplace_back("encoder resolution not told: it is taken from the record unchecked");
  if (!p.rated_torque.is_there()) lines.emplace_back("rated torque not told: it is taken from the record unchecked");
  return lines;
}

}  // namespace ligature::platform
