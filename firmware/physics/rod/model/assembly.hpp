#pragma once
// The linear system of one substep: linearised implicit Euler for the new velocities.

#include "firmware/physics/rod/model/state.hpp"
#include "firmware/physics/rod/solve/band_solver.hpp"

namespace ligature::physics::rod {

/// Fills `solver` with the matrix A and the right-hand side r of A v = r for the new velocities v:
///   A = M (1 + c dt) + dt (dt + tau_b) K_b + dt (dt + tau_s) K_ax + dt^2 K_geo + holds
///   r = M v0 + dt f(x0) + holds
/// M: masses, c: air drag, tau_b, tau_s: damping times of bending and stretch, v0, x0: present velocities and
/// positions.
/// K_b: bending matrix (mesh.hpp). K_ax, K_geo: sums over all segments (vector e = |e| u, rest length l, tension T) of
///   (EA / l) u u^T   and   max(T, 0) / |e| (I - u u^T)
/// Compression is left out of K_geo, so that A stays positive definite. f: gravity, loads, stretch, bending and, with
/// `Twist`, the force of the twisting moment on the centreline (twist.hpp). Supports enter as a large mass, hands as an
/// implicit spring and damper. O(n); no allocation.
template <bool Twist>
void assemble(const Material& material, const State& state, Vec gravity, double dt_s, Forces& forces,
              BandSolver& solver) noexcept;

/// Kinetic and potential energies, J, and the largest strain of a segment. The stress-free parts of strain and bend
/// (State::rest_strain, rest_bend) store no elastic energy.
struct Energy {
  double kinetic_J = 0.0, stretch_J = 0.0, bend_J = 0.0, gravity_J = 0.0, max_strain = 0.0;
  double give_J = 0.0;  ///< elastic energy of contacts (ContactSet::give_J)
};
[[nodiscard]] Energy energy(const Material& material, const State& state, Vec gravity) noexcept;

}  // namespace ligature::physics::rod
