#pragma once
// Rehearsal: a scene that a command wants to load is first built and run for a while in a separate process, which may
// crash without harm.

#include <string>

#include "firmware/app/options.hpp"
#include "firmware/physics/simulation.hpp"

namespace ligature::app {

/// Simulates a copy of the suture for 0.4 s while both hands pull back and forth. @return why the scene is not usable;
/// empty if it is.
[[nodiscard]] std::string rehearse(const physics::Simulation& thread);

/// The `rehearse` command: reads, builds and rehearses the scene. With a hand speed given, it also draws a knot tight
/// and measures the time lost. Memory and CPU time of its process are limited. @return the exit code: 0 usable, 2 not
/// usable, 3 loses time; the reason is on stderr. Any other end (signal, other code) also means that the scene is not
/// usable.
[[nodiscard]] int rehearse_scene(const RehearseOptions& options);

}  // namespace ligature::app
