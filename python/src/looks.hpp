#pragma once
// Read access to the state of a simulation.

#include "python/src/arrays.hpp"
#include "python/src/sim.hpp"

namespace ligature::python {

using Floats = View<float, nb::ndim<1>>;
using Reals = View<double, nb::ndim<1>>;

[[nodiscard]] Floats tension_N(const physics::Simulation& simulation);
[[nodiscard]] Floats turn_rad(const physics::Simulation& simulation);
/// The contacts of physics::Simulation::contacts() as a tuple of arrays for k contacts: pairs (k x 2), places, normals
/// and forces (k x 3), gaps (k).
[[nodiscard]] nb::tuple contacts(const physics::Simulation& simulation);
[[nodiscard]] Reals curvature_per_m(const physics::Simulation& simulation);

/// Binds Hand and Diagnostics.
void bind_looks(nb::module_& module);

}  // namespace ligature::python
