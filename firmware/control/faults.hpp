#pragma once
// Fault numbers. They are part of the interface (docs/architecture.md), so a number is never reused for another fault.

#include <cstddef>
#include <cstdint>

#include "firmware/rt/rig_io.hpp"

namespace ligature::control {

enum class Fault : std::int16_t {
  kNone = 0,
  kBusLost = 10,          ///< a hand's bus is gone: peer closed, interface down
  kTpdoTooOld = 11,       ///< no complete set of joint messages within the watchdog time
  kDriveFault = 12,       ///< a drive is in Fault, sent EMCY, or left Operation enabled by itself
  kForeignTorque = 13,    ///< another node on a hand's bus sends RPDOs
  kForeignBeat = 14,      ///< another node sends SYNC or a controller's heartbeat
  kForeignNetwork = 15,   ///< another node sends NMT commands
  kForeignObject = 16,    ///< another node sends SDO requests
  kFramesLost = 17,       ///< for a while more than a third of a hand's samples or torques were lost
  kSamplesBurst = 18,     ///< the tip seems too fast, but its samples had stopped and may have come in a burst
  kNonFinite = 20,        ///< a force or position is not a number
  kVelocityLimit = 21,    ///< tip faster than kVelocityFault times the device's limit
  kEncoderFrozen = 22,    ///< a joint's reading suddenly stopped while the others moved on
  kAxisReversed = 23,     ///< a joint's reading reversed its motion within one period, as if its sign had flipped
  kButtonsStuck = 24,     ///< the button module's counter stands still
  kForceStays = 25,       ///< force is still not zero long after the gain became 0
  kTorqueAstray = 26,     ///< a drive reports a torque that it was not asked for
  kOverrun = 30,          ///< the loop lost as many periods in a row as the watchdog allows
  kPhysicsDiverged = 40,  ///< the thread's state is not finite
  kThreadLate = 41,       ///< the physics is behind by as many ticks as the watchdog allows
};

/// A fault of one joint's encoder.
struct JointFault {
  Fault fault = Fault::kNone;
  std::int8_t joint = -1;  ///< -1: no fault
  bool operator==(const JointFault&) const = default;
};
[[nodiscard]] constexpr JointFault fault_of_joint(Fault fault, std::size_t joint) noexcept {
  return {fault, static_cast<std::int8_t>(joint)};
}

[[nodiscard]] constexpr Fault fault_of(rt::Foreign kind) noexcept {
  switch (kind) {
    case rt::Foreign::kNone:
      break;
    case rt::Foreign::kTorque:
      return Fault::kForeignTorque;
    case rt::Foreign::kBeat:
      return Fault::kForeignBeat;
    case rt::Foreign::kNetwork:
      return Fault::kForeignNetwork;
    case rt::Foreign::kObject:
      return Fault::kForeignObject;
  }
  return Fault::kNone;
}

/// Whether only a restart of the program clears this fault. After it, nobody knows what another node may have written
/// into the drives, and only a restart reads and writes their settings again.
[[nodiscard]] constexpr bool needs_restart(Fault f) noexcept {
  return (f >= Fault::kForeignTorque && f <= Fault::kForeignObject) || f == Fault::kTorqueAstray;
}

[[nodiscard]] constexpr const char* name(Fault f) noexcept {
  switch (f) {
    case Fault::kNone:
      return "none";
    case Fault::kBusLost:
      return "bus lost";
    case Fault::kTpdoTooOld:
      return "joint messages too old";
    case Fault::kDriveFault:
      return "drive fault";
    case Fault::kForeignTorque:
      return "somebody else on the bus commands torque";
    case Fault::kForeignBeat:
      return "SYNC or heartbeat of another controller on the bus";
    case Fault::kForeignNetwork:
      return "somebody else on the bus commands the drives' network state";
    case Fault::kForeignObject:
      return "somebody else on the bus reads or writes the drives' objects";
    case Fault::kFramesLost:
      return "too many frames lost";
    case Fault::kSamplesBurst:
      return "joint messages stopped, then came in a burst";
    case Fault::kNonFinite:
      return "force or position is not finite";
    case Fault::kVelocityLimit:
      return "velocity limit";
    case Fault::kEncoderFrozen:
      return "encoder frozen";
    case Fault::kAxisReversed:
      return "axis reversed";
    case Fault::kButtonsStuck:
      return "buttons stuck";
    case Fault::kForceStays:
      return "force does not end";
    case Fault::kTorqueAstray:
      return "torque that nobody commanded";
    case Fault::kOverrun:
      return "control loop overrun";
    case Fault::kPhysicsDiverged:
      return "thread simulation diverged";
    case Fault::kThreadLate:
      return "thread simulation late";
  }
  return "unknown";
}

}  // namespace ligature::control
