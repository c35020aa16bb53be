#include "firmware/physics/paper/internal_step.hpp"

#include <type_traits>

#include "firmware/physics/paper/banded.hpp"
#include "firmware/physics/paper/bend_damper.hpp"
#include "firmware/physics/paper/bend_spring.hpp"
#include "firmware/physics/paper/stretch_damper.hpp"
#include "firmware/physics/paper/stretch_spring.hpp"
#include "firmware/physics/paper/swivel_damper.hpp"

// Every loop runs over packs of four nodes, so it may include up to three nodes past the end. Segments there have zero
// length, so their directions, axes and gradients are zero: their results are finite and have no effect.

namespace ligature::physics {
namespace {

constexpr double kShortest = 1e-9;  // lower bound of a segment's length in divisions, relative to the rest length

// A swivel damper shares nodes with up to three others on each side, so the dampers can be divided into four sets
// (colours) without common nodes. A Jacobi step that gives each damper the weight 1/4, with the factor 1 / (1 + 4 k dt
// g^T M^-1 g), therefore cannot overshoot (k: coefficient, g: gradient of the damper's angle, M: masses).
constexpr double kColours = 4.0;

/// Computes for each segment its direction, its length, the impulse dt T_i of its spring (tension T_i), and gain_i: the
/// additional impulse of its damper per stretch rate.
template <Terms T>
void measure_segments(const ThreadModel& m, const ThreadState& s, InternalWorkspace& w) noexcept {
  using Law = std::conditional_t<T.quadratic_stretch, QuadraticStretchLaw, LinearStretch>;
  const double dt = m.step_s;
  Pack most = splat(-1.0), energy = splat(0.0);
  for (int i = 0; i < m.nodes - 1; i += kLanes) {
    const auto seg = segment_of<Pack>(s.p.pack(i), s.p.pack(i + 1), splat(kShortest * m.rest_m));
    const Pack strain = seg.length_m * (1.0 / m.rest_m) - 1.0;
    most = larger(most, strain);
    energy += m.segment.pack(i) * Law::energy_J(strain, m.stretch_N, m.rest_m);
    w.u.set(i, seg.u);
    w.inv_length.set(i, seg.inv_length);
    Pack gain = splat(m.stretch_N_s_per_m * dt);
    // The spring of model 5 is implicit too, because its stiffness grows without bound with the strain
    if constexpr (T.quadratic_stretch && !T.explicit_damping)
      gain += dt * dt * Law::slope_N_per_m(strain, m.stretch_N, m.rest_m);
    w.pull.set(i, dt * Law::tension_N(strain, m.stretch_N));
    w.gain.set(i, gain);
  }
  w.max_strain = largest(most);
  w.stretch_J = sum(energy);
}

/// Adds the impulses of the stretch dampers to those of the springs, and applies both. In the implicit form a damper
/// acts on the stretch rate after the step:
///   pull_i = dt T_i + gain_i rate_i(v after)
template <Terms T>
void apply_stretch(const ThreadModel& m, ThreadState& s, const Lane3& rate_v, InternalWorkspace& w) noexcept {
  const Lane& mass = m.inverse_mass_per_kg;
  for (int i = 0; i < m.nodes - 1; i += kLanes) {
    const V3<Pack> u = w.u.pack(i);
    const Pack gain = w.gain.pack(i);
    w.pull.set(i, w.pull.pack(i) + gain * stretch_rate(u, rate_v.pack(i), rate_v.pack(i + 1)));
    if constexpr (!T.explicit_damping) {
      w.diag.set(i, 1.0 + gain * (mass.pack(i) + mass.pack(i + 1)));
      w.link.set(i, mass.pack(i) * dot(w.u.pack(i - 1), u));
    }
  }
  if constexpr (!T.explicit_damping)
    solve_tridiagonal(m.nodes - 1, w.diag.data(), w.gain.data(), w.link.data(), w.pull.data());
  for (int i = 0; i < m.nodes; i += kLanes) {
    const Pack k = mass.pack(i);
    s.v.set(i, s.v.pack(i) + (k * w.pull.pack(i)) * w.u.pack(i) - (k * w.pull.pack(i - 1)) * w.u.pack(i - 1));
  }
}

/// Angles, axes and gradients of all bends, and impulses dt M_i of the bend springs.
template <Terms T>
void measure_bends(const ThreadModel& m, InternalWorkspace& w) noexcept {
  const double dt = m.step_s;
  Pack energy = splat(0.0);
  for (int i = 1; i < m.nodes - 1; i += kLanes) {
    const Bend<Pack> b = bend_of(w.u.pack(i - 1), w.u.pack(i), w.inv_length.pack(i - 1), w.inv_length.pack(i));
    energy += bend_energy_J(b.angle, m.bend_N_m);
    w.left.set(i, b.grad_left);
    w.right.set(i, b.grad_right);
    if constexpr (T.swivel_internal || T.swivel_paper) {
      w.axis.set(i, b.axis);
      w.sine.set(i, b.sine);
      w.cosine.set(i, b.cosine);
    }
    w.turn.set(i, dt * bend_moment_N_m(b.angle, m.bend_N_m));
  }
  w.bend_J = sum(energy);
}

/// Applies the bend impulses in w.turn to the velocities.
void apply_turns(const ThreadModel& m, ThreadState& s, const InternalWorkspace& w) noexcept {
  for (int i = 0; i < m.nodes; i += kLanes) {
    const Pack before = w.turn.pack(i - 1), here = w.turn.pack(i), after = w.turn.pack(i + 1);
    const V3<Pack> push =
        before * w.right.pack(i - 1) - here * (w.left.pack(i) + w.right.pack(i)) + after * w.left.pack(i + 1);
    s.v.set(i, s.v.pack(i) + m.inverse_mass_per_kg.pack(i) * push);
  }
}

/// Impulses `turn` of the bend dampers (coefficient k): explicit, -k dt rate; implicit, the solution of the
/// pentadiagonal system
///   (1 + k dt G M^-1 G^T) turn = -k dt rate,   G: gradients of all angles.
template <Terms T>
void damp_bends(const ThreadModel& m, ThreadState& s, const Lane3& rate_v, InternalWorkspace& w) noexcept {
  const double k = m.bend_N_m_s * m.step_s;
  const Lane& mass = m.inverse_mass_per_kg;
  for (int i = 1; i < m.nodes - 1; i += kLanes) {
    const V3<Pack> a = w.left.pack(i), c = w.right.pack(i);
    w.turn.set(i, bend_damper_moment_N_m(bend_rate(a, c, rate_v.pack(i - 1), rate_v.pack(i), rate_v.pack(i + 1)), k));
    if constexpr (!T.explicit_damping) {
      const V3<Pack> b = -(a + c), a1 = w.left.pack(i + 1), b1 = -(a1 + w.right.pack(i + 1)), a2 = w.left.pack(i + 2);
      const Pack w0 = mass.pack(i - 1), w1 = mass.pack(i), w2 = mass.pack(i + 1);
      w.diag.set(i, 1.0 + k * (w0 * dot(a, a) + w1 * dot(b, b) + w2 * dot(c, c)));
      w.one.set(i, k * (w1 * dot(b, a1) + w2 * dot(c, b1)));
      w.two.set(i, k * (w2 * dot(c, a2)));
    }
  }
  if constexpr (!T.explicit_damping)
    solve_pentadiagonal(m.nodes - 2, w.diag.data() + 1, w.one.data() + 1, w.two.data() + 1, w.turn.data() + 1);
  apply_turns(m, s, w);
}

/// Impulse of a damper at a given rate of its length or angle. @param k_dt coefficient times dt. @param mobility change
/// of the rate per unit impulse, g^T M^-1 g (g: gradient of the length or angle, M: masses).
template <Terms T>
Pack damper_impulse(Pack k_dt, Pack rate, Pack mobility) noexcept {
  if constexpr (T.explicit_damping) return -k_dt * rate;
  return -k_dt * rate / (1.0 + kColours * k_dt * mobility);
}

template <Terms T>
void measure_swivel(const ThreadModel& m, const Lane3& rate_v, InternalWorkspace& w) noexcept {
  const Lane& mass = m.inverse_mass_per_kg;
  for (int i = 1; i < m.nodes - 1; i += kLanes) {
    SwivelRates<Pack> r = swivel_rates(w.axis.pack(i), rate_v.pack(i - 1), rate_v.pack(i), rate_v.pack(i + 1));
    if constexpr (T.swivel_paper) {
      const double k = m.swivel_N_s * m.step_s;
      const Pack left = paper_swivel_N_s_per_m(w.inv_length.pack(i - 1), k);
      const Pack right = paper_swivel_N_s_per_m(w.inv_length.pack(i), k);
      r.left = damper_impulse<T>(left, r.left, mass.pack(i - 1) + mass.pack(i));
      r.right = damper_impulse<T>(right, r.right, mass.pack(i + 1) + mass.pack(i));
    }
    w.swing_left.set(i, r.left);
    w.swing_right.set(i, r.right);
  }
}

/// Impulses of the dihedral dampers. Dihedral i joins the bends i and i + 1, and its impulses act along the axes of
/// both. The part for bend i overwrites the rates in swing_left and swing_right, which are no longer needed; the part
/// for bend i + 1 goes into next_left and next_right.
template <Terms T>
void couple_dihedrals(const ThreadModel& m, InternalWorkspace& w) noexcept {
  const Lane& mass = m.inverse_mass_per_kg;
  const Pack k = splat(m.swivel_N_s * m.rest_m * m.step_s);
  for (int i = 1; i < m.nodes - 1; i += kLanes) {
    const auto d = dihedral_of(w.sine.pack(i), w.cosine.pack(i), w.sine.pack(i + 1), w.cosine.pack(i + 1),
                               w.inv_length.pack(i - 1), w.inv_length.pack(i), w.inv_length.pack(i + 1));
    const Pack rate = dihedral_rate(d, {w.swing_left.pack(i), w.swing_right.pack(i)},
                                    {w.swing_left.pack(i + 1), w.swing_right.pack(i + 1)});
    const Pack mobility = dihedral_mobility(d, dot(w.axis.pack(i), w.axis.pack(i + 1)), mass.pack(i - 1), mass.pack(i),
                                            mass.pack(i + 1), mass.pack(i + 2));
    const Pack impulse = damper_impulse<T>(k, rate, mobility);
    w.swing_left.set(i, impulse * d.p0);
    w.swing_right.set(i, impulse * d.p2);
    w.next_left.set(i, impulse * d.q1);
    w.next_right.set(i, impulse * d.q3);
  }
}

template <Terms T>
void apply_swivel(const ThreadModel& m, ThreadState& s, const InternalWorkspace& w) noexcept {
  const auto left = [&w](int i) {
    if constexpr (T.swivel_internal) return w.swing_left.pack(i) + w.next_left.pack(i - 1);
    return w.swing_left.pack(i);
  };
  const auto right = [&w](int i) {
    if constexpr (T.swivel_internal) return w.swing_right.pack(i) + w.next_right.pack(i - 1);
    return w.swing_right.pack(i);
  };
  for (int i = 0; i < m.nodes; i += kLanes) {
    const V3<Pack> push =
        right(i - 1) * w.axis.pack(i - 1) - (left(i) + right(i)) * w.axis.pack(i) + left(i + 1) * w.axis.pack(i + 1);
    s.v.set(i, s.v.pack(i) + m.inverse_mass_per_kg.pack(i) * push);
  }
}

/// Springs act before dampers. So in equilibrium the velocities are zero when the dampers act, and damping cannot shift
/// the equilibrium.
template <Terms T>
void internal_step(const ThreadModel& m, ThreadState& s, const Lane3& before_v, InternalWorkspace& w) noexcept {
  const Lane3& rate_v = T.explicit_damping ? before_v : s.v;
  measure_segments<T>(m, s, w);
  if constexpr (T.bend) {
    measure_bends<T>(m, w);
    apply_turns(m, s, w);
  }
  apply_stretch<T>(m, s, rate_v, w);
  if constexpr (T.bend_damper) damp_bends<T>(m, s, rate_v, w);
  if constexpr (T.swivel_internal || T.swivel_paper) {
    measure_swivel<T>(m, rate_v, w);
    if constexpr (T.swivel_internal) couple_dihedrals<T>(m, w);
    apply_swivel<T>(m, s, w);
  }
}

template <bool explicit_damping>
InternalStep choose(const scene::Suture& s) noexcept {
  constexpr bool e = explicit_damping;
  const bool paper = s.paper.swivel == scene::SwivelDamper::kPaper;
  switch (s.model) {
    case scene::Model::kPaper1:
      return internal_step<Terms{.explicit_damping = e}>;
    case scene::Model::kPaper2:
      return internal_step<Terms{.bend = true, .explicit_damping = e}>;
    case scene::Model::kPaper3:
      return internal_step<Terms{.bend = true, .bend_damper = true, .explicit_damping = e}>;
    case scene::Model::kPaper4:
      if (paper)
        return internal_step<Terms{.bend = true, .bend_damper = true, .swivel_paper = true, .explicit_damping = e}>;
      return internal_step<Terms{.bend = true, .bend_damper = true, .swivel_internal = true, .explicit_damping = e}>;
    case scene::Model::kPaper5:
      if (paper)
        return internal_step<Terms{
            .quadratic_stretch = true, .bend = true, .bend_damper = true, .swivel_paper = true, .explicit_damping = e}>;
      return internal_step<Terms{.quadratic_stretch = true,
                                 .bend = true,
                                 .bend_damper = true,
                                 .swivel_internal = true,
                                 .explicit_damping = e}>;
    case scene::Model::kRod:
      break;
  }
  return nullptr;
}

}  // namespace

InternalStep choose_internal_step(const scene::Suture& s) noexcept {
  return s.paper.damping == scene::Damping::kExplicit ? choose<true>(s) : choose<false>(s);
}

}  // namespace ligature::physics
