#pragma once
// What a scene may promise on this machine, measured before anybody is armed: that the loop is in time, whatever the
// thread does, and how much of its time the thread keeps.

#include <optional>
#include <string>
#include <vector>

#include "firmware/app/drawn_knot.hpp"
#include "firmware/app/meter.hpp"
#include "firmware/app/options.hpp"
#include "protocol/scene/scene.hpp"

namespace ligature::app {

struct Admission {
  LoopCost loop;
  ThreadCost thread;
  std::vector<DrawnKnot> knots;  ///< empty: not tried
  double budget_percent = kDefaultBudget_percent;
  [[nodiscard]] double computing_us() const noexcept { return loop.control_us + loop.calls_us; }
  [[nodiscard]] double budget_us() const noexcept { return 10.0 * budget_percent; }
  /// The loop's way from SYNC to torques and record does; the thread is ended by the clock and cannot hold it up.
  [[nodiscard]] bool fits() const noexcept { return computing_us() <= budget_us(); }
};

/// Measure on whatever core the calling thread may use.
inline constexpr int kAnyCore = -1;

struct AdmissionSettings {
  double seconds = 0.3;  ///< to spend on worst shapes
  int core = kAnyCore;
  double budget_percent = kDefaultBudget_percent;
  bool draw_knots = false;
};

/// @param scene one that physics::Simulation::make() accepts. Without `suture.work_instructions` the thread's work is
/// chosen so that the dearest tick of a drawn knot ends by itself; what is worse, the clock ends.
[[nodiscard]] Admission admit(const scene::Scene& scene, const AdmissionSettings& settings);

/// Phase by phase against what is allowed, and what the thread loses.
[[nodiscard]] std::string table(const Admission& admission);

/// Why such a scene must not run: the loop is too slow, or it loses time at hands' speeds up to `no_loss_m_per_s` (0:
/// may). Nothing when it may run.
[[nodiscard]] std::optional<std::string> objection_of(const Admission& admission, double no_loss_m_per_s = 0.0);

}  // namespace ligature::app
