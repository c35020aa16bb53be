#include "firmware/physics/rod/assembly.hpp"

#include <algorithm>

namespace ligature::physics::rod {
namespace {

constexpr double kSupportMass_kg = 1e6;  // moves a millionth of a nanometre a substep under 1 N

// Stretch of every segment: tangent e / l, tension EA (|e| / l - 1), its pull into `edge`, its stiffness into the matrix.
void add_stretch(const Material& m, const State& state, double dt, Forces& f, BandSolver& a) noexcept {
  const Mesh& mesh = state.mesh;
  const std::size_t n = mesh.s.size();
  const double axial = dt * (dt + m.stretch_tau_s) * m.EA_N;
  Mat before{};
  for (std::size_t j = 0; j < n; ++j) {
    Mat here{};
    if (j + 1 < n) {
      const Vec e = state.x[j + 1] - state.x[j];
      const double inv_length = 1.0 / norm(e);
      const Vec u = inv_length * e;
      const double tension = m.EA_N * (1.0 / (inv_length * mesh.rest[j]) - 1.0);
      f.tangent[j] = mesh.inv_rest[j] * e;
      f.tension[j] = tension;
      f.edge[j] = tension * u;
      const double across = dt * dt * std::max(tension, 0.0) * inv_length;
      here = dyad(u, axial * mesh.inv_rest[j] - across, across);
    }
    const Mat both = before + here;
    a.diagonal[j] = both;
    a.couple[j] = -1.0 * here;
    before = here;
  }
}

// Bending moments w (t_i - t_{i-1} - rest) and the transverse force they put on segments.
template <bool Twist>
void add_bending(const Material& m, const State& state, Forces& f) noexcept {
  const Mesh& mesh = state.mesh;
  const std::size_t n = mesh.s.size();
  f.moment_in[0] = f.moment_out[0] = f.moment_in[n - 1] = f.moment_out[n - 1] = Vec{};
  for (std::size_t i = 1; i + 1 < n; ++i) {
    const Vec q = mesh.weight[i] * (f.tangent[i] - f.tangent[i - 1] - state.rest_bend[i]);
    f.moment_in[i] = f.moment_out[i] = q;
  }
  for (int h = 0; h < state.hold_count; ++h) {
    const Hold& hold = state.holds[static_cast<std::size_t>(h)];
    if (hold.node < 0 || !hold.directed) continue;
    const auto i = static_cast<std::size_t>(hold.node);
    if (i > 0) f.moment_in[i] = 2.0 * m.EI_N_m2 * mesh.inv_rest[i - 1] * (hold.direction - f.tangent[i - 1]);
    if (i + 1 < n) f.moment_out[i] = 2.0 * m.EI_N_m2 * mesh.inv_rest[i] * (f.tangent[i] - hold.direction);
  }
  for (std::size_t j = 0; j + 1 < n; ++j) f.edge[j] -= mesh.inv_rest[j] * (f.moment_in[j + 1] - f.moment_out[j]);
  if constexpr (Twist) {
    for (std::size_t j = 0; j + 1 < n; ++j) f.edge[j] += 0.5 * mesh.inv_rest[j] * (f.twist[j] + f.twist[j + 1]);
  }
}

void add_holds(const State& state, double dt, BandSolver& a) noexcept {
  for (int h = 0; h < state.hold_count; ++h) {
    const Hold& hold = state.holds[static_cast<std::size_t>(h)];
    if (hold.node < 0) continue;
    const auto i = static_cast<std::size_t>(hold.node);
    if (hold.rigid) {
      a.diagonal[i] = a.diagonal[i] + scaled_identity(kSupportMass_kg);
      a.rhs[i] += kSupportMass_kg / dt * (hold.target - state.x[i]);
    } else {
      const double k = hold.stiffness_N_per_m, b = hold.damping_N_s_per_m;
      a.diagonal[i] = a.diagonal[i] + scaled_identity(dt * (b + dt * k));
      a.rhs[i] += dt * (k * (hold.target - state.x[i]) + b * hold.velocity);
    }
  }
}

// kappa b of a vertex [Bergou 2008]: 2 a x c / (1 + a . c) of unit tangents.
Vec binormal(Vec a, Vec c) noexcept { return 2.0 / (1.0 + dot(a, c)) * cross(a, c); }

// Force of the twisting moment: -M grad(turn), grad on the ends of segment j = M (kb_j + kb_{j+1}) / 2 l_j.
void add_twist(const State& state, Forces& f) noexcept {
  const std::size_t n = state.mesh.s.size();
  const auto unit = [&](std::size_t j) { return 1.0 / norm(f.tangent[j]) * f.tangent[j]; };
  for (auto& t : f.twist) t = Vec{};
  Vec before = unit(0);
  for (std::size_t i = 1; i + 1 < n; ++i) {
    const Vec after = unit(i);
    f.twist[i] = f.twist_moment[i] * binormal(before, after);
    before = after;
  }
  for (int h = 0; h < state.hold_count; ++h) {
    const Hold& hold = state.holds[static_cast<std::size_t>(h)];
    if (hold.node < 0 || !hold.directed) continue;
    const auto i = static_cast<std::size_t>(hold.node);
    if (i == 0) f.twist[0] = f.twist_moment[0] * binormal(hold.direction, unit(0));
    if (i + 1 == n) f.twist[i] = f.twist_moment[i] * binormal(unit(i - 1), hold.direction);
  }
}

}  // namespace

template <bool Twist>
void assemble(const Material& material, const State& state, Vec gravity, double dt_s, Forces& forces,
              BandSolver& solver) noexcept {
  const Mesh& mesh = state.mesh;
  const std::size_t n = mesh.s.size();
  add_stretch(material, state, dt_s, forces, solver);
  if constexpr (Twist) add_twist(state, forces);
  add_bending<Twist>(material, state, forces);
  const double bend = dt_s * (dt_s + material.bend_tau_s);
  const double inertia = 1.0 + material.drag_per_s * dt_s;
  Vec before{};
  for (std::size_t i = 0; i < n; ++i) {
    const Vec here = i + 1 < n ? forces.edge[i] : Vec{};
    const double m = mesh.mass[i];
    solver.diagonal[i] = solver.diagonal[i] + scaled_identity(m * inertia + bend * mesh.kd[i]);
    solver.couple[i] = solver.couple[i] + scaled_identity(bend * mesh.ke[i]);
    solver.skip[i] = bend * mesh.kb[i];
    solver.rhs[i] = m * (state.v[i] + dt_s * gravity) + dt_s * (here - before + state.load[i]);
    before = here;
  }
  add_holds(state, dt_s, solver);
}

template void assemble<false>(const Material&, const State&, Vec, double, Forces&, BandSolver&) noexcept;
template void assemble<true>(const Material&, const State&, Vec, double, Forces&, BandSolver&) noexcept;

Energy energy(const Material& material, const State& state, Vec gravity) noexcept {
  const Mesh& mesh = state.mesh;
  Energy e;
  Vec before{};
  for (std::size_t i = 0; i < mesh.s.size(); ++i) {
    e.kinetic_J += 0.5 * mesh.mass[i] * dot(state.v[i], state.v[i]);
    e.gravity_J -= mesh.mass[i] * dot(gravity, state.x[i]);
    if (i + 1 == mesh.s.size()) break;
    const Vec t = mesh.inv_rest[i] * (state.x[i + 1] - state.x[i]);
    const double strain = norm(t) - 1.0;
    e.stretch_J += 0.5 * material.EA_N * strain * strain * mesh.rest[i];
    e.max_strain = std::max(e.max_strain, strain);
    if (i > 0) {
      const Vec q = t - before - state.rest_bend[i];
      e.bend_J += 0.5 * mesh.weight[i] * dot(q, q);
    }
    before = t;
  }
  for (int h = 0; h < state.hold_count; ++h) {
    const Hold& hold = state.holds[static_cast<std::size_t>(h)];
    if (hold.node < 0 || !hold.directed) continue;
    const auto i = static_cast<std::size_t>(hold.node);
    const auto half = [&](std::size_t j) {
      const Vec q = mesh.inv_rest[j] * (state.x[j + 1] - state.x[j]) - hold.direction;
      e.bend_J += material.EI_N_m2 * mesh.inv_rest[j] * dot(q, q);
    };
    if (i > 0) half(i - 1);
    if (i + 1 < mesh.s.size()) half(i);
  }
  return e;
}

}  // namespace ligature::physics::rod
