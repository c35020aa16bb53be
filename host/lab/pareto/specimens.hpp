#pragma once
// The two threads of the map, ready for its experiments at any setting.

#include <optional>
#include <variant>

#include "firmware/physics/rod/rod_simulation.hpp"
#include "host/lab/pareto/setting.hpp"
#include "host/lab/validate/specimen.hpp"

namespace ligature::lab {

/// A thread behind either facade: the rod's own one lets its numerics be set.
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

/// The 0.3 m suture, or the paper's 5 m thread (Table I per length), at the setting's nodes and time steps; gravity.
[[nodiscard]] scene::Scene thread_of(const Setting& setting);

/// Fewest substeps of a 1 ms tick at which an explicit model is well inside its stability limit.
[[nodiscard]] int stable_substeps(scene::Model model, int nodes);

/// Instructions are counted in here and nowhere else.
void measured_tick(Specimen& specimen, const validate::Tools& tools) noexcept;

}  // namespace ligature::lab
