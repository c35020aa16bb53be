#pragma once
// What an attacked rig truly did to two hands, judged SYNC by SYNC from the torques that the motors made and the poses
// that the arms truly had.

#include <map>
#include <string>

#include "tests/integration/virtual_rig/attack.hpp"

namespace ligature {

/// A promise that was not kept at some SYNCs, and why.
struct Exception {
  std::string promise, cause;
  auto operator<=>(const Exception&) const = default;
};
struct Times {
  int runs = 0, syncs = 0;         ///< syncs: both hands'
  double worst = 0.0;              ///< N; for "outside ARM and dead-man" ticks in a row
  std::uint64_t seed = 0;          ///< of the worst
  std::size_t hand = 0, tick = 0;  ///< there
};

/// Of one run, or of many.
struct Findings {
  int runs = 0, refused = 0, pushed = 0, faulted = 0, lying = 0;  ///< refused: did not start; pushed: above 0.5 N
  double peak_N = 0.0, step_N = 0.0;                              ///< true and within the promises: largest
  std::map<Exception, Times> exceptions;
  std::map<int, int> faults;  ///< number -> runs

  void add(const Findings& other);
};

inline constexpr double kTrueForce_N = 3.4, kTrueStep_N = 0.55;
inline constexpr int kTicksToEnd = 152;     ///< of a force after its arming or dead-man went
inline constexpr int kTicksOfFault = 24;    ///< until the drives are free by themselves, at the latest
inline constexpr int kTicksOfFlood = 40;    ///< the same while a stranger leaves hardly any room on the bus
inline constexpr int kTicksOfStranger = 4;  ///< of torque that somebody else commands, from his first frame on
inline constexpr int kTicksOfLoss = 12;     ///< in a row that a frame may be lost: 0.2^12
inline constexpr int kTicksToSee = 3;       ///< until a foreign frame is a fault in the records
inline const std::string kUnexplained = "unexplained";

[[nodiscard]] Findings judge(const AttackPlan& plan, const lab::VirtualRig& rig);

}  // namespace ligature
