#pragma once
// What ODrive drives are set to, as far as the controller needs it: table [odrive] of a device record. CANSimple cannot
// read these settings back; start-up tries those that safety depends on. docs/drives.md explains them.

#include <cstdint>

#include "protocol/device/cia402_profile.hpp"

namespace ligature::device {

struct OdriveProfile {
  /// The drive removes its torque when no torque message came for watchdog_ms; kRpdoTimer or kNone
  DriveWatchdog watchdog = DriveWatchdog::kRpdoTimer;
  int watchdog_ms = 20;                    ///< as set in the drives
  int heartbeat_ms = 10;                   ///< longest period of the drives' heartbeat, as set in them
  std::uint32_t buttons_id = 0x201;        ///< identifier of the frames of the button module
  double torque_constant_Nm_per_A = 0.0;   ///< as set in the drives; the current limit follows from it
  double velocity_limit_rev_per_s = 20.0;  ///< above it the drive makes no torque in the direction of motion
};

}  // namespace ligature::device
