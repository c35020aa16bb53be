#include "firmware/physics/rod/model/assembly.hpp"

#include <algorithm>

namespace ligature::physics::rod {
namespace {

constexpr double kSupportMass_kg = 1e6;  // large: under 1 N a support moves 1e-14 m per substep at most

// For every segment (vector e, rest length l): tangent e / l, unit vector e / |e|, tension EA (|e| / l - 1 -
// stress-free strain).
void measure(const Material& m, const State& state, Forces& f) noexcept {
  const Mesh& mesh = state.mesh;
  const std::size_t count = mesh.s.size() - 1;
  std::size_t j = 0;
  for (; j + 4 <= count; j += 4) {  // four at a time, as square roots and divisions dominate the cost
    const Vec* const x = state.x.data() + j;
    const Vec e0 = x[1] - x[0], e1 = x[2] - x[1], e2 = x[3] - x[2], e3 = x[4] - x[3];
    const Lanes length2 = squares(e0, e1, e2, e3), inverse = 1.0 / root(length2);
    const Lanes inv_rest = load(mesh.inv_rest.data() + j);
    const auto put_segment = [&](std::size_t k, Vec e) {
      f.tangent[j + k].v = inv_rest[k] * e.v;
      f.unit[j + k].v = inverse[k] * e.v;
    };
    put_segment(0, e0), put_segment(1, e1), put_segment(2, e2), put_segment(3, e3);
    store(f.shortening.data() + j, inverse * load(mesh.rest.data() + j));
    store(f.tension.data() + j, m.EA_N * (length2 * inverse * inv_rest - 1.0 - load(state.rest_strain.data() + j)));
  }
  for (; j < count; ++j) {
    const Vec e = state.x[j + 1] - state.x[j];
    const double length2 = dot(e, e), inverse = 1.0 / std::sqrt(length2);
    f.tangent[j] = mesh.inv_rest[j] * e;
    f.unit[j] = inverse * e;
    f.shortening[j] = inverse * mesh.rest[j];
    f.tension[j] = m.EA_N * (length2 * inverse * mesh.inv_rest[j] - 1.0 - state.rest_strain[j]);
  }
}

// Curvature binormal of a vertex with the unit tangents a before and c after it: 2 a x c / (1 + a . c) [Bergou 2008].
Vec binormal(Vec a, Vec c) noexcept { return 2.0 / (1.0 + dot(a, c)) * cross(a, c); }

// Computes M / (1 + a . c) for the inner vertices, four at a time. M: twisting moment, a, c: unit tangents before and
// after the vertex. This number times a x c is half of M times the curvature binormal.
void half_twists(Forces& f, std::size_t n) noexcept {
  const Vec* const u = f.unit.data();
  std::size_t i = 1;
  for (; i + 4 < n; i += 4) {
    const Lanes cosine =
        sums(u[i - 1].v * u[i].v, u[i].v * u[i + 1].v, u[i + 1].v * u[i + 2].v, u[i + 2].v * u[i + 3].v);
    store(f.half_twist.data() + i, load(f.twist_moment.data() + i) / (1.0 + cosine));
  }
  for (; i + 1 < n; ++i) f.half_twist[i] = f.twist_moment[i] / (1.0 + dot(u[i - 1], u[i]));
}

// Every vertex (node between two segments) acts on both of its segments with the sum of two terms. The bending term is
// w (t_i - t_{i-1} - stress-free bend), where w is EI over the length of the vertex. The twist term is half of the
// twisting moment times the curvature binormal. The transverse force of a segment is the difference of these sums at
// its two ends, divided by its length.
template <bool Twist>
void vertices(const State& state, Forces& f) noexcept {
  const Mesh& mesh = state.mesh;
  const std::size_t n = mesh.s.size();
  f.moment_in[0] = f.moment_out[0] = f.moment_in[n - 1] = f.moment_out[n - 1] = Vec{};
  if constexpr (Twist) half_twists(f, n);
  for (std::size_t i = 1; i + 1 < n; ++i) {
    const Vec q = mesh.weight[i] * (f.tangent[i] - f.tangent[i - 1] - state.rest_bend[i]);
    f.moment_in[i] = f.moment_out[i] = q;
    if constexpr (Twist) {
      const Vec half = f.half_twist[i] * cross(f.unit[i - 1], f.unit[i]);
      f.moment_in[i] -= f.shortening[i - 1] * half;
      f.moment_out[i] += f.shortening[i] * half;
    }
  }
  for (const Hold& hold : state.slots()) {
    if (hold.node < 0 || !hold.directed) continue;
    const auto i = static_cast<std::size_t>(hold.node);
    const Vec d = hold.direction;
    if (i > 0) {
      f.moment_in[i] = 2.0 * mesh.EI_before[i] * mesh.inv_rest[i - 1] * (d - f.tangent[i - 1]);
      if (Twist && i + 1 == n)
        f.moment_in[i] -= 0.5 * f.shortening[i - 1] * f.twist_moment[i] * binormal(f.unit[i - 1], d);
    }
    if (i + 1 < n) {
      f.moment_out[i] = 2.0 * mesh.EI_after[i] * mesh.inv_rest[i] * (f.tangent[i] - d);
      if (Twist && i == 0) f.moment_out[i] += 0.5 * f.shortening[i] * f.twist_moment[i] * binormal(d, f.unit[i]);
    }
  }
}

void add_holds(const State& state, double dt, BandSolver& a) noexcept {
  for (const Hold& hold : state.slots()) {
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

}  // namespace

template <bool Twist>
void assemble(const Material& material, const State& state, Vec gravity, double dt_s, Forces& forces,
              BandSolver& solver) noexcept {
  const Mesh& mesh = state.mesh;
  const std::size_t n = mesh.s.size();
  measure(material, state, forces);
  vertices<Twist>(state, forces);
  const double bend = dt_s * (dt_s + material.bend_tau_s),
               axial = dt_s * (dt_s + material.stretch_tau_s) * material.EA_N;
  const double inertia = 1.0 + material.drag_per_s * dt_s;
  Vec before{};
  Mat stiff_before{};
  double across_before = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    Vec here{};
    Mat stiff{};
    double across = 0.0;
    if (i + 1 < n) {
      const double tension = forces.tension[i], l = mesh.inv_rest[i];
      here = tension * forces.unit[i] - l * (forces.moment_in[i + 1] - forces.moment_out[i]);
      across = dt_s * dt_s * std::max(tension, 0.0) * l;  // |e| approximated by l: strains are a few per cent
      stiff = dyad(forces.unit[i], axial * l - across);
      put(solver.couple[i], scaled_identity(bend * mesh.ke[i] - across) - stiff);
    }
    const double m = mesh.mass[i];
    put(solver.diagonal[i],
        stiff_before + stiff + scaled_identity(m * inertia + bend * mesh.kd[i] + across_before + across));
    solver.skip[i] = bend * mesh.kb[i];
    solver.rhs[i] = m * (state.v[i] + dt_s * gravity) + dt_s * (here - before + state.load[i]);
    forces.edge[i] = before = here;
    stiff_before = stiff;
    across_before = across;
  }
  add_holds(state, dt_s, solver);
}

template void assemble<false>(const Material&, const State&, Vec, double, Forces&, BandSolver&) noexcept;
template void assemble<true>(const Material&, const State&, Vec, double, Forces&, BandSolver&) noexcept;

Energy energy(const Material& material, const State& state, Vec gravity) noexcept {
  const Mesh& mesh = state.mesh;
  Energy e;
  for (std::size_t i = 0; i < mesh.s.size(); ++i) {
    e.kinetic_J += 0.5 * mesh.mass[i] * dot(state.v[i], state.v[i]);
    e.gravity_J -= mesh.mass[i] * dot(gravity, state.x[i]);
    if (i + 1 == mesh.s.size()) break;
    const double strain = state.strain(i), stressed = strain - state.rest_strain[i];
    e.stretch_J += 0.5 * material.EA_N * stressed * stressed * mesh.rest[i];
    e.max_strain = std::max(e.max_strain, strain);
    if (i == 0) continue;
    const Vec q = state.elastic_bend(i);
    e.bend_J += 0.5 * mesh.weight[i] * dot(q, q);
  }
  for (const Hold& hold : state.slots()) {
    if (hold.node < 0 || !hold.directed) continue;
    const auto i = static_cast<std::size_t>(hold.node);
    const auto half = [&](std::size_t j, double EI_N_m2) {
      const Vec q = state.tangent(j) - hold.direction;
      e.bend_J += EI_N_m2 * mesh.inv_rest[j] * dot(q, q);
    };
    if (i > 0) half(i - 1, mesh.EI_before[i]);
    if (i + 1 < mesh.s.size()) half(i, mesh.EI_after[i]);
  }
  return e;
}

}  // namespace ligature::physics::rod
