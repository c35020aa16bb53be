#pragma once
// Runs of the virtual rig while hands pull hard, on a bus that loses or corrupts frames, or with an encoder that
// becomes wrong: the fault, and the true force.

#include <cstdint>
#include <string>
#include <vector>

#include "protocol/scene/fault_script.hpp"

namespace ligature {

struct BadBus {
  double lost = 0.0;   ///< share of process data frames lost, in either direction
  double wrong = 0.0;  ///< share of the drives' frames with a wrong bit
  bool left = true, right = false;
  std::int64_t ticks = 300;  ///< number of ticks evaluated after the onset
};

/// Times are in ticks of 1 ms after the onset.
struct BadBusEnd {
  int fault = 0;
  std::int64_t to_fault = -1;
  std::int64_t to_zero = 0;   ///< until no motor of the rig has torque
  bool pushed_after = false;  ///< a torque was sent after the fault
  double peak_N = 0.0;        ///< largest true force at either tip after the onset
};

inline constexpr std::int64_t kBadBusOnset = 1500;

/// One run in virtual time. The seed determines the hands (AttackPlan::pulls) and the losses.
[[nodiscard]] BadBusEnd end_of(const BadBus& bus, std::uint64_t seed);

/// An encoder of the left hand that becomes wrong.
struct WrongEncoder {
  scene::FaultKind kind = scene::FaultKind::kFreeze;
  int node = 0;    ///< 1 .. 3, from the waist to the forearm; 0: no encoder becomes wrong
  int counts = 0;  ///< by which an encoder is off, for FaultKind::kJump
};

struct WrongEncoderEnd {
  int fault = 0;
  // largest true force at the left tip, and its largest step, except where a fault removes all force
  double peak_N = 0.0, step_N = 0.0;
};

/// One run in virtual time. The seed determines the hands, and the onset (1.1 to 1.6 s).
[[nodiscard]] WrongEncoderEnd end_of(const WrongEncoder& encoder, std::uint64_t seed);

/// Ticks within which all force must be gone when this share of the frames on a hand's bus is lost; 0 where no fault is
/// required. It is the time to the fault (stated in docs/architecture.md, exceeded once in a million runs), plus the
/// time until the motors' torque is off.
[[nodiscard]] std::int64_t ticks_to_zero_at(double frames_lost);

}  // namespace ligature
