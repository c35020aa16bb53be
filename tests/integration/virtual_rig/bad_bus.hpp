#pragma once
// A bus that is bad and not dead, under hands that pull hard: what becomes of the force.

#include <cstdint>
#include <string>
#include <vector>

namespace ligature {

struct BadBus {
  double lost = 0.0;   ///< share of process data frames, either way
  double wrong = 0.0;  ///< share of the drives' frames with a wrong bit
  bool left = true, right = false;
  std::int64_t ticks = 300;  ///< to look at after the onset
};

/// In ticks of 1 ms from the onset.
struct BadBusEnd {
  int fault = 0;
  std::int64_t to_fault = -1;
  std::int64_t to_zero = 0;   ///< until no motor of the rig has torque
  bool pushed_after = false;  ///< a torque was sent after the fault
  double peak_N = 0.0;        ///< true force at either tip after the onset
};

inline constexpr std::int64_t kBadBusOnset = 1500;

/// One run in virtual time. The hands (AttackPlan::pulls) and what is lost come from the seed.
[[nodiscard]] BadBusEnd end_of(const BadBus& bus, std::uint64_t seed);

/// From which share of frames lost on a hand's bus is always a fault, and within how many ticks all force is then gone;
/// 0 where it need not be one. The ticks are those of LossWatch.ABadBus..., with the way to the motors.
[[nodiscard]] std::int64_t ticks_to_zero_at(double frames_lost);

}  // namespace ligature
