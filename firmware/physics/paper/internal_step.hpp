#pragma once

#include "firmware/physics/paper/thread.hpp"
#include "protocol/scene/scene.hpp"

namespace ligature::physics {

/// Force laws of a model. A law that is false is not compiled into that model's step.
struct Terms {
  bool quadratic_stretch = false;
  bool bend = false;
  bool bend_damper = false;
  bool swivel_internal = false;
  bool swivel_paper = false;
  bool explicit_damping = false;
};

/// Applies the impulses of one step's internal forces to the velocities: first springs, then dampers of stretch, bend
/// and swivel (rotation of the plane of one bend against that of the next one, swivel_damper.hpp). The dampers are
/// implicit: those of stretch by a tridiagonal system, those of bend by a pentadiagonal one, those of swivel by one
/// weighted Jacobi step that never overshoots. So they dissipate energy for any coefficient and time step, and conserve
/// linear and angular momentum. With explicit_damping they act as printed in the paper.
/// @param rate_v  velocities at the beginning of the step, for explicit dampers; unused otherwise
using InternalStep = void (*)(const ThreadModel&, ThreadState&, const Lane3& rate_v, InternalWorkspace&) noexcept;

/// The step compiled for a scene's model and options; chosen once.
[[nodiscard]] InternalStep choose_internal_step(const scene::Suture& suture) noexcept;

}  // namespace ligature::physics
