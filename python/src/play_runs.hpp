#pragma once
// Runs started from Python. The GIL is released meanwhile, and Ctrl-C stops them.

#include <nanobind/nanobind.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/vector.h>

#include <optional>
#include <vector>

#include "protocol/scene/gripper_script.hpp"
#include "python/src/run.hpp"
#include "python/src/sim.hpp"

namespace ligature::python {

[[nodiscard]] Run run_here(Sim& sim, const scene::GripperScript& script, std::optional<double> duration_s,
                           double shape_every_s, double start_s);
[[nodiscard]] std::vector<Run> run_copies(Sim& sim, const std::vector<const scene::GripperScript*>& scripts,
                                          int threads, std::optional<double> duration_s, double shape_every_s,
                                          double start_s);

}  // namespace ligature::python
