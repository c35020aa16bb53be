#pragma once
// Admission: measures, before the rig can be armed, whether the loop keeps its period on this machine whatever the
// suture does, and which share of simulated time the suture's physics loses.

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "firmware/app/drawn_knot.hpp"
#include "firmware/app/driver_time.hpp"
#include "firmware/app/meter.hpp"
#include "firmware/app/options.hpp"
#include "firmware/rt/bus_time.hpp"
#include "protocol/device/device.hpp"
#include "protocol/scene/scene.hpp"

namespace ligature::app {

struct Admission {
  LoopCost loop;
  ThreadCost thread;
  std::vector<DrawnKnot> knots;  ///< empty: not measured
  double budget_percent = kDefaultBudget_percent;
  rt::BusTime bus;
  DriverTime driver{};  ///< its calls are in loop.calls_us
  [[nodiscard]] double computing_us() const noexcept { return loop.control_us + loop.calls_us; }
  /// What bus traffic and drivers leave of a period for the loop's computing.
  [[nodiscard]] double left_us() const noexcept {
    return 1e-3 * static_cast<double>(bus.most_work().count()) - driver.delays_us();
  }
  /// Time allowed for the loop's computing: the budget, but no more than is left.
  [[nodiscard]] double budget_us() const noexcept { return std::max(0.0, std::min(10.0 * budget_percent, left_us())); }
  /// How late the loop may wake up and still get its torques to the drives before the next SYNC.
  [[nodiscard]] double slack_us() const noexcept { return left_us() - computing_us(); }
  /// Whether the loop's work (control law, record, bus calls) fits the budget. The physics needs no check: it stops at
  /// its deadline and cannot delay the loop.
  [[nodiscard]] bool fits() const noexcept { return computing_us() <= budget_us(); }
};

/// This core number means: measure on any core that the calling thread may use.
inline constexpr int kAnyCore = -1;

struct AdmissionSettings {
  double seconds = 0.3;  ///< time spent on measuring worst-case shapes
  int core = kAnyCore;
  double budget_percent = kDefaultBudget_percent;
  bool draw_knots = false;
  device::Device device = device::omni();  ///< its drives determine how long the bus takes
  DriverTime driver{};                     ///< of the CAN interfaces, if they were measured
};

/// @param scene  a scene that physics::Simulation::make() accepts. If the scene sets no `suture.work_instructions`,
/// this function chooses a work budget with which 99 % of the ticks end in time while a knot is drawn tight. The clock
/// ends all other ticks at their deadline.
[[nodiscard]] Admission admit(const scene::Scene& scene, const AdmissionSettings& settings);

/// Readable table: the cost of each phase against its allowance, and the share of time that the suture's physics loses.
[[nodiscard]] std::string table(const Admission& admission);

/// Why the scene must not run: the loop is too slow, or the suture's physics loses time at a hand speed up to
/// `no_loss_m_per_s` (0: lost time is allowed). Nothing: the scene may run.
[[nodiscard]] std::optional<std::string> objection_of(const Admission& admission, double no_loss_m_per_s = 0.0);

}  // namespace ligature::app
