#pragma once
// Plays a scene and an operator's script through the physics, tick by tick, without real time.

#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "firmware/physics/simulation.hpp"
#include "host/knot/recognise.hpp"
#include "host/lab/loading.hpp"
#include "protocol/scene/gripper_script.hpp"
#include "protocol/scene/scene.hpp"
#include "sim_device/operator/knot_tier.hpp"

namespace ligature::lab {

class Rehearsal {
 public:
  /// @param scene_name name in messages;  @throws Refusal when the physics refuses the scene.
  Rehearsal(const scene::Scene& scene, scene::GripperScript script, const std::string& scene_name = "scene");

  /// From now on a simulated operator moves the hands, and sees the thread as it was one tick ago; the script is
  /// ignored.
  void let(sim::KnotTier tier) { tier_.emplace(std::move(tier)); }
  [[nodiscard]] const std::optional<sim::KnotTier>& tier() const noexcept { return tier_; }

  /// Runs one tick with both hands at the script's positions for the end of the tick. False when the state is not
  /// finite. @throws validate::Interrupted where validate::stop_asked is set, which `run` does not do.
  bool tick();

  /// Runs until time t (nearest tick); false when the run diverged before.
  bool run_until(double t_s);

  /// Time, s. Dividing by an integer rate gives the double nearest to the decimal number: 700 * 0.001 is
  /// 0.7000000000000001, 700 / 1000 is 0.7.
  [[nodiscard]] double time_s() const noexcept {
    const double rate_Hz = 1.0 / tick_s_, whole_Hz = std::round(rate_Hz);
    const bool is_whole = std::abs(rate_Hz - whole_Hz) <= 1e-12 * rate_Hz;
    return is_whole ? static_cast<double>(ticks_) / whole_Hz : static_cast<double>(ticks_) * tick_s_;
  }
  [[nodiscard]] std::int64_t ticks() const noexcept { return ticks_; }
  [[nodiscard]] double last_tick_us() const noexcept { return last_tick_us_; }  ///< CPU time of the last tick, us
  [[nodiscard]] physics::Simulation& simulation() noexcept { return simulation_; }
  [[nodiscard]] const physics::Simulation& simulation() const noexcept { return simulation_; }
  [[nodiscard]] const scene::Scene& scene() const noexcept { return scene_; }
  [[nodiscard]] const scene::GripperScript& script() const noexcept { return script_; }

 private:
  [[nodiscard]] std::array<physics::ToolInput, 2> tools_at(double t_s);

  scene::Scene scene_;
  scene::GripperScript script_;
  physics::Simulation simulation_;
  std::optional<sim::KnotTier> tier_;
  double tick_s_;
  std::int64_t ticks_ = 0;
  double last_tick_us_ = 0.0;
};

/// Names the knot of a thread with free ends.
[[nodiscard]] knot::KnotResult knot_of(const physics::Simulation& simulation);

}  // namespace ligature::lab
