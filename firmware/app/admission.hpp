#pragma once
// Whether a scene's worst tick fits into the period, measured on the core that will run it, before anybody is armed.

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "firmware/app/meter.hpp"
#include "protocol/scene/scene.hpp"

namespace ligature::app {

inline constexpr double kDefaultBudget_percent = 60.0;

struct Admission {
  WorstCase worst;
  double budget_percent = kDefaultBudget_percent;
  /// SYNC and TPDOs of a bus at its longest (bits, stuffed), during which the loop waits and computes nothing.
  double bus_us = 0.0;
  [[nodiscard]] double computing_us() const noexcept { return worst.thread_us + worst.control_us + worst.calls_us; }
  [[nodiscard]] double budget_us() const noexcept { return 10.0 * budget_percent; }
  /// Within the budget, and together with the bus within the period.
  [[nodiscard]] bool fits() const noexcept {
    return computing_us() <= budget_us() && bus_us + computing_us() <= 1000.0;
  }
};

/// Measure on whatever core the calling thread may use.
inline constexpr int kAnyCore = -1;

/// @param scene one that physics::Simulation::make() accepts. @param seconds to spend. @param core to measure on.
[[nodiscard]] Admission admit(const scene::Scene& scene, double seconds, int core,
                              double budget_percent = kDefaultBudget_percent);

/// What a scene costs, found in so many seconds: admit() on one core, or a table of costs in a test.
using Measure = std::function<Admission(const scene::Scene&, double seconds)>;
[[nodiscard]] Measure measure_on(int core, double budget_percent);

/// The largest `nodes` of this scene that fits, by bisection, about `seconds` in all, and measured again in the end;
/// nothing when not even 2 do. Fewer nodes of a rod are longer segments, and much of its bound does not depend on them.
[[nodiscard]] std::optional<int> largest_nodes(scene::Scene scene, double seconds, const Measure& measure);

/// Phase by phase against the budget, a table of fixed width.
[[nodiscard]] std::string table(const Admission& admission);

}  // namespace ligature::app
