#pragma once
// The threads used in the pareto measurements, at any setting.

#include <optional>
#include <variant>

#include "firmware/physics/rod/rod_simulation.hpp"
#include "host/lab/pareto/setting.hpp"
#include "host/lab/validate/specimen.hpp"

namespace ligature::lab {

/// A thread simulated by physics::Simulation, or by RodSimulation where numerical parameters of the rod are to be set.
class Specimen {
 public:
  /// @throws std::runtime_error when the physics refuses the scene.
  Specimen(const scene::Scene& scene, const Setting& setting);

  void tick(const validate::Tools& tools) noexcept;
  [[nodiscard]] std::span<const physics::Vec3> nodes_W() const noexcept;
  [[nodiscard]] const physics::HandContact& hand(physics::Hand h) const noexcept;
  [[nodiscard]] const physics::Diagnostics& diagnostics() const noexcept;

 private:
  std::variant<std::monostate, physics::Simulation, physics::rod::RodSimulation> thread_;
};

/// The scene of a setting: the 0.3 m suture, or the paper's 5 m thread (Table I, converted to values per length), with
/// the setting's nodes and time steps, under gravity.
[[nodiscard]] scene::Scene thread_of(const Setting& setting);

/// Smallest number of substeps per 1 ms tick at which an explicit model is stable with a margin.
[[nodiscard]] int stable_substeps(scene::Model model, int nodes);

/// One tick; the only function whose instructions callgrind counts.
void measured_tick(Specimen& specimen, const validate::Tools& tools) noexcept;

}  // namespace ligature::lab
