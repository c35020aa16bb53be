#pragma once
// Fault numbers: part of the interface (docs/architecture.md), never reused for another meaning.

#include <cstdint>

#include "firmware/rt/rig_io.hpp"

namespace ligature::control {

enum class Fault : std::int16_t {
  kNone = 0,
  kBusLost = 10,          ///< a hand's bus is gone: peer closed, interface down
  kTpdoTooOld = 11,       ///< no complete set of joint messages within the watchdog time
  kDriveFault = 12,       ///< a drive is in Fault, sent EMCY, or left Operation enabled by itself
  kForeignTorque = 13,    ///< somebody else on a hand's bus sends RPDOs
  kForeignBeat = 14,      ///< ... SYNC or a controller's heartbeat
  kForeignNetwork = 15,   ///< ... NMT commands
  kForeignObject = 16,    ///< ... SDO requests
  kFramesLost = 17,       ///< more than a third of a hand's samples or torques do not come, for a while
  kNonFinite = 20,        ///< a force or position is not a number
  kVelocityLimit = 21,    ///< tip faster than kVelocityFault times the device's limit
  kEncoderFrozen = 22,    ///< a joint stopped dead while the others moved on
  kAxisReversed = 23,     ///< a joint turned back in one period, as in a mirror
  kButtonsStuck = 24,     ///< the buttons' own life sign stands still, or a pair of contacts disagrees
  kForceStays = 25,       ///< a hand's gain is 0 and its force still does not end
  kTorqueAstray = 26,     ///< a drive says that it makes a torque that nobody asked for
  kOverrun = 30,          ///< the loop lost as many periods in a row as the watchdog allows
  kPhysicsDiverged = 40,  ///< the thread's state is not finite
  kThreadLate = 41,       ///< the thread's physics has not seen the tools of as many ticks as the watchdog allows
};

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

/// No reset leaves these: the drives are off the network, and what somebody wrote into them is not known. A start reads
/// and writes them anew.
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
