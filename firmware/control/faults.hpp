#pragma once
// Fault numbers: part of the interface (docs/architecture.md), never reused for another meaning.

#include <cstdint>

namespace ligature::control {

enum class Fault : std::int16_t {
  kNone = 0,
  kBusLost = 10,          ///< a hand's bus is gone: peer closed, interface down
  kTpdoTooOld = 11,       ///< no complete set of joint messages within the watchdog time
  kDriveFault = 12,       ///< a drive is in Fault, sent EMCY, or left Operation enabled by itself
  kNonFinite = 20,        ///< a force or position is not a number
  kVelocityLimit = 21,    ///< tip faster than kVelocityFault times the device's limit
  kEncoderFrozen = 22,    ///< a joint stopped dead while the others moved on
  kAxisReversed = 23,     ///< a joint turned back in one period while the others moved on
  kButtonsStuck = 24,     ///< the buttons' own life sign stands still, or a pair of contacts disagrees
  kForceStays = 25,       ///< a hand's gain is 0 and its force still does not end
  kOverrun = 30,          ///< the loop lost as many periods in a row as the watchdog allows
  kPhysicsDiverged = 40,  ///< the thread's state is not finite
  kThreadLate = 41,       ///< the thread's physics has not seen the tools of as many ticks as the watchdog allows
};

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
