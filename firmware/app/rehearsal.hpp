#pragma once
// Whether a scene that a command asks for may come near the loop: built and tried, in a process that it may take down.

#include <string>

#include "firmware/app/options.hpp"
#include "firmware/physics/simulation.hpp"

namespace ligature::app {

/// Runs a copy for a while, both hands pulling to and fro. @return why it will not do, or empty.
[[nodiscard]] std::string rehearse(const physics::Simulation& thread);

/// `rehearse`: reads, builds, rehearses and, on request, draws a knot, within limits of memory and CPU time that it
/// sets for itself. @return the exit code: 0 it will do, 2 it will not, 3 it loses time; the reason is on stderr.
/// Whatever else ends it (a signal, another code) is the scene's doing, too.
[[nodiscard]] int rehearse_scene(const RehearseOptions& options);

}  // namespace ligature::app
