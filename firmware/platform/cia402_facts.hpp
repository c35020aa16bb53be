#pragma once
// What follows for start-up and supervision from the table [cia402] of a device record.

#include <string>
#include <vector>

#include "protocol/can/startup.hpp"
#include "protocol/device/device.hpp"

namespace ligature::platform {

/// Values that start-up checks and sets in the drives of a device.
[[nodiscard]] can::DriveFacts drive_facts(const device::Device& device) noexcept;

/// @param watchdog_ms requested time of the drives' watchdog; the device record may require a longer one
[[nodiscard]] can::StartupTimes startup_times(const device::Device& device, int watchdog_ms) noexcept;

/// Ticks between two heartbeats of the controller. If the heartbeat is the drives' only watchdog: a quarter of the time
/// after which the drives report it missing. Else half of kDefaultHeartbeat_ms, so that one heartbeat may be lost.
[[nodiscard]] int heartbeat_periods(const device::Device& device, int watchdog_ms) noexcept;

/// What the drives of this record cannot promise, one line each.
[[nodiscard]] std::vector<std::string> lacks_of(const device::Device& device, int watchdog_ms);

}  // namespace ligature::platform
