#pragma once
// Rehearsal: before a commanded scene reaches the loop, it is built and run for a while in a process of its own, which
// may crash.

#include <string>

#include "firmware/app/options.hpp"
#include "firmware/physics/simulation.hpp"

namespace ligature::app {

/// Steps a copy of the thread for 0.4 s while both hands pull back and forth. @return why the scene is not usable, or
/// empty.
[[nodiscard]] std::string rehearse(const physics::Simulation& thread);

/// The `rehearse` command: reads, builds and rehearses the scene and, if asked, draws a knot, under its own limits of
/// memory and CPU time. @return the exit code: 0 usable, 2 not usable, 3 loses time; the reason is on stderr. Any other
/// end (signal, other code) also means that the scene is not usable.
[[nodiscard]] int rehearse_scene(const RehearseOptions& options);

}  // namespace ligature::app
