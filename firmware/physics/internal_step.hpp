#pragma once

#include "firmware/physics/thread.hpp"
#include "protocol/scene/scene.hpp"

namespace ligature::physics {

/// Which laws a model is made of. A term that is false is not compiled into that model's step.
struct Terms {
  bool quadratic_stretch = false;
  bool bend = false;
  bool bend_damper = false;
  bool swivel_internal = false;
  bool swivel_paper = false;
  bool explicit_damping = false;
};

/// Applies the impulses of one step's internal forces to the velocities: springs, then stretch, bend and swivel
/// dampers. Dampers are implicit: each kind solves for impulses that are right for the velocities they leave behind
/// (stretch: a tridiagonal system, bend: a pentadiagonal one; swivel: one weighted Jacobi step that never overshoots).
/// So they take energy out at any coefficient and any step, and conserve both momenta. With explicit_damping they act
/// as printed.
/// @param rate_v  velocities that explicit dampers see (those at the beginning of the step); unused otherwise
using InternalStep = void (*)(const ThreadModel&, ThreadState&, const Lane3& rate_v, InternalWorkspace&) noexcept;

/// The step compiled for a scene's model and options; chosen once.
[[nodiscard]] InternalStep choose_internal_step(const scene::Suture& suture) noexcept;

}  // namespace ligature::physics
