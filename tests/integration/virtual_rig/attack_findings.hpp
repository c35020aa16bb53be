#pragma once
// What an attacked rig really did to two hands, evaluated at each SYNC from the motors' true torques and the arms' true
// poses.

#include <map>
#include <string>

#include "tests/integration/virtual_rig/attack.hpp"

namespace ligature {

/// A promise of the rig that was broken at some SYNCs, and the cause.
struct Exception {
  std::string promise, cause;
  auto operator<=>(const Exception&) const = default;
};
struct Times {
  int runs = 0, syncs = 0;  ///< number of SYNCs, summed over both hands
  /// The largest value found, N. Exception: for the promise "outside ARM and dead-man" it is a number of consecutive
  /// ticks.
  double worst = 0.0;
  std::uint64_t seed = 0;          ///< of the run with the worst value
  std::size_t hand = 0, tick = 0;  ///< of the worst value
};

/// Results of one run, or summed over many.
struct Findings {
  /// Numbers of runs; refused: the rig did not start; pushed: force above 0.5 N; lying: with encoder faults.
  int runs = 0, refused = 0, pushed = 0, faulted = 0, lying = 0;
  double peak_N = 0.0, step_N = 0.0;  ///< largest true values within the promises
  std::map<Exception, Times> exceptions;
  std::map<int, int> faults;  ///< fault number -> number of runs

  void add(const Findings& other);
};

inline constexpr double kTrueForce_N = 3.4, kTrueStep_N = 0.55;
inline constexpr int kTicksToEnd = 152;   ///< ticks until a force has ended after disarming or release of the dead-man
inline constexpr int kTicksOfFault = 24;  ///< ticks until the drives switch off by their own watchdog, at the latest
inline constexpr int kTicksOfFlood = 40;  ///< the same while foreign frames fill the bus
inline constexpr int kTicksOfStranger = 4;  ///< ticks for which a foreign torque may act after its first frame
inline constexpr int kTicksOfLoss = 12;     ///< ticks in a row in which a frame may be lost (probability 0.2^12)
inline constexpr int kTicksToSee = 3;       ///< ticks until the records show a fault for a foreign frame
inline const std::string kUnexplained = "unexplained";

[[nodiscard]] Findings judge(const AttackPlan& plan, const lab::VirtualRig& rig);

}  // namespace ligature
