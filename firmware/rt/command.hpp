#pragma once
// Commands to the real-time thread.

#include <cstdint>

#include "firmware/rt/payload.hpp"

namespace ligature::rt {

/// Values as in protocol/lcm/command_t.lcm, part of the interface.
enum class CommandKind : std::int8_t {
  kNone = 0,
  kArm = 1,
  kDisarm = 2,
  kStop = 3,
  kResetFault = 4,
  kResetThread = 5,
  kClutchLeft = 9,  ///< 6 and 7 (load-scene, set) are handled by telemetry; 8 is unused
  kUnclutchLeft = 10,
  kClutchRight = 11,
  kUnclutchRight = 12,
  kPark = 13,
  kCalibrate = 14,
};

struct Command {
  std::int64_t id = 0;
  CommandKind kind = CommandKind::kNone;
};

static_assert(Payload<Command>);

}  // namespace ligature::rt
