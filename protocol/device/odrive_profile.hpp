#pragma once
// What ODrive drives are set to, as far as the controller needs it: table [odrive] of a device record. CANSimple cannot
// read these settings back. docs/drives.md explains them.

#include <cstdint>

#include "protocol/device/cia402_profile.hpp"

namespace ligature::device {

struct OdriveProfile {
  /// The drive removes its torque when no torque message came for watchdog_ms; kRpdoTimer or kNone
  DriveWatchdog watchdog = DriveWatchdog::kRpdoTimer;
  int watchdog_ms = 20;              ///< as set in the drives
  int heartbeat_ms = 20;             ///< period of the drives' heartbeat, as set in them
  std::uint32_t buttons_id = 0x201;  ///< identifier of the frames of the button module
};

}  // namespace ligature::device
