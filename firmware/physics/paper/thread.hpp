#pragma once
// A thread of the paper's models: constants (ThreadModel), state (ThreadState), work arrays (InternalWorkspace).

#include "firmware/physics/members.hpp"
#include "firmware/physics/paper/lanes.hpp"

namespace ligature::physics {

/// Constants of one simulated thread, per node; SI.
struct ThreadModel {
  int nodes = 0;
  double rest_m = 0.0;  ///< l_r, rest length of a segment
  double radius_m = 0.0;
  double mass_kg = 0.0;            ///< mass of one node
  double stretch_N = 0.0;          ///< k_l, stretch stiffness (model 5: times kStiffQuadratic if the scene says so)
  double stretch_N_s_per_m = 0.0;  ///< k_d, stretch damping
  double bend_N_m = 0.0;           ///< k_ts, bending stiffness
  double bend_N_m_s = 0.0;         ///< k_td, bending damping
  double swivel_N_s = 0.0;         ///< k_sw, swivel damping
  double drag_per_s = 0.0;         ///< c of the air drag a = -c v
  double step_s = 0.0;
  Lane inverse_mass_per_kg;  ///< 0 for fixed nodes
  Lane free;                 ///< 1, or 0 for fixed nodes
  Lane segment;              ///< 1 if segment i .. i + 1 exists, else 0
  LIGATURE_MEMBERS(ThreadModel, nodes, rest_m, radius_m, mass_kg, stretch_N, stretch_N_s_per_m, bend_N_m, bend_N_m_s,
                   swivel_N_s, drag_per_s, step_s, inverse_mass_per_kg, free, segment)
};

struct ThreadState {
  Lane3 p;  ///< m
  Lane3 v;  ///< m/s
  LIGATURE_MEMBERS(ThreadState, p, v)
};

/// Intermediate results of a step. A bend has the index of its middle node, a segment that of its left node.
struct InternalWorkspace {
  Lane3 u;                  ///< segment directions, (4)
  Lane inv_length;          ///< 1/m
  Lane pull;                ///< stretch impulse, N s, positive in tension
  Lane gain, link;          ///< implicit stretch damper: impulse per stretch rate, kg; coupling of neighbours, 1/kg
  Lane diag, one, two;      ///< banded matrices of the implicit dampers
  Lane3 axis, left, right;  ///< axis and gradients of each bend; see Bend
  Lane sine, cosine;
  Lane turn;                     ///< bend impulse, N m s
  Lane swing_left, swing_right;  ///< swivel rates, then swivel impulses along the axis, at the nodes before and after
  Lane next_left, next_right;    ///< impulses of dihedral i at the next bend, i + 1
  double max_strain = 0.0;
  double stretch_J = 0.0, bend_J = 0.0;
  LIGATURE_MEMBERS(InternalWorkspace, u, inv_length, pull, gain, link, diag, one, two, axis, left, right, sine, cosine,
                   turn, swing_left, swing_right, next_left, next_right, max_strain, stretch_J, bend_J)

  InternalWorkspace() = default;
  explicit InternalWorkspace(int n)
      : u(n),
        inv_length(n),
        pull(n),
        gain(n),
        link(n),
        diag(n),
        one(n),
        two(n),
        axis(n),
        left(n),
        right(n),
        sine(n),
        cosine(n),
        turn(n),
        swing_left(n),
        swing_right(n),
        next_left(n),
        next_right(n) {}
};

/// Repeats the last node's position past the end of the arrays, so that the segments there have zero length and no
/// direction.
inline void extend_last_node(Lane3& p, int nodes) noexcept {
  const V3<double> last = p.at(nodes - 1);
  for (int k = 0; k < kLanes; ++k) p.put(nodes + k, last);
}

}  // namespace ligature::physics
