#include "firmware/platform/make_drives.hpp"

#include "firmware/platform/cia402_drives.hpp"
#include "firmware/platform/cia402_facts.hpp"
#include "firmware/platform/cia402_time.hpp"
#include "firmware/platform/moteus_drives.hpp"
#include "firmware/platform/moteus_time.hpp"
#include "firmware/platform/odrive_drives.hpp"
#include "firmware/platform/odrive_time.hpp"

namespace ligature::platform {

std::unique_ptr<HandDrives> make_drives(CanBus& bus, const device::Device& device, int watchdog_ms, std::size_t hand) {
  if (device.odrive) return std::make_unique<OdriveDrives>(bus, device, watchdog_ms);
  if (device.moteus) return std::make_unique<MoteusDrives>(bus, device, watchdog_ms);
  return std::make_unique<Cia402Drives>(bus, device, watchdog_ms, hand);
}

rt::BusTime bus_time_of(const device::Device& device) noexcept {
  if (device.odrive) return odrive_time();
  if (device.moteus) return moteus_time();
  const device::Cia402Profile& p = device.cia402;
  return cia402_time(p.buttons.are_inputs() ? static_cast<unsigned>(p.buttons.bits) / 8U : 0U,
                     p.watchdog == device::DriveWatchdog::kHeartbeat);
}

std::vector<std::string> lacks_of_record(const device::Device& device, int watchdog_ms) {
  if (device.moteus) return moteus_lacks();
  return device.odrive ? odrive_lacks(*device.odrive) : lacks_of(device, watchdog_ms);
}

can::Network network_of(const device::Device& device) noexcept {
  return device.moteus ? can::Network::kFd : can::Network::kClassic;
}

bool have_watchdog(const device::Device& device) noexcept {
  if (device.moteus) return false;  // what its drives do after their watchdog is stored in them, and is not read
  return (device.odrive ? device.odrive->watchdog : device.cia402.watchdog) != device::DriveWatchdog::kNone;
}

}  // namespace ligature::platform
