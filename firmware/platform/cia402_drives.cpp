#include "firmware/platform/cia402_drives.hpp"

#include "firmware/platform/can_master.hpp"
#include "firmware/platform/cia402_facts.hpp"
#include "firmware/platform/make_drives.hpp"

namespace ligature::platform {

Cia402Drives::Cia402Drives(CanBus& bus, const device::Device& device, int watchdog_ms, std::size_t hand)
    : bus_(bus),
      times_(startup_times(device, watchdog_ms)),
      lacks_(lacks_of(device, watchdog_ms)),
      time_(bus_time_of(device)),
      link_(bus, device, heartbeat_periods(device, watchdog_ms), hand) {}

std::optional<std::string> Cia402Drives::other_controller(BusWait& wait) { return other_master(bus_, wait); }

std::optional<std::string> Cia402Drives::configure(BusWait& wait) {
  return configure_drives(bus_, wait, times_, &lacks_);
}

std::vector<can::Frame> Cia402Drives::example_samples() const {
  std::vector<can::Frame> frames;
  frames.reserve(can::profile::kJointNodes.size() + 1);
  for (const can::NodeId node : can::profile::kJointNodes) frames.push_back(can::encode(node, can::Tpdo1{}));
  const can::ButtonsSource& buttons = times_.drive.buttons;
  if (buttons.own_pdo)
    frames.push_back({can::pdo_place(false, 2, buttons.node).id, static_cast<std::uint8_t>(buttons.bits / 8), {}});
  return frames;
}

bool Cia402Drives::start() noexcept { return start_drives(bus_); }

std::optional<std::string> Cia402Drives::release(BusWait& wait) {
  release_drives(bus_, wait, times_.drive.watchdog);
  return std::nullopt;
}

}  // namespace ligature::platform
