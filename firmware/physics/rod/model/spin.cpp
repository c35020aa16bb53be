// Computes the segments' roll rates: twisting moments, the tridiagonal system of a substep, and the response to
// contacts.

#include "firmware/physics/rod/model/spin.hpp"

#include <algorithm>

namespace ligature::physics::rod {
namespace {

double inertia(const Material& m, double length) noexcept {
  return 0.5 * m.density_kg_per_m * m.radius_m * m.radius_m * length;
}

}  // namespace

void Spin::give_moments(const Material& material, const State& state, Forces& forces) const noexcept {
  const std::size_t edges = state.x.size() - 1;
  for (std::size_t i = 0; i <= edges; ++i) {
    const double share = i == 0 || i == edges ? 1.0 : 0.5;  // mean of both sides; an end has only one
    forces.twist_moment[i] = share * (into_vertex(material, state, i) + out_of_vertex(material, state, i));
  }
}

// Twisting moment at vertex i, N m, on the side of segment i - 1 (into_vertex()) and on that of segment i
// (out_of_vertex()). The two differ where a hold fixes the roll.
double Spin::into_vertex(const Material& m, const State& state, std::size_t i) const noexcept {
  if (i == 0) return 0.0;
  if (held_[i]) return m.GJ_N_m2 * (2.0 * before_[i] * state.mesh.inv_rest[i - 1] - m.born_twist_per_m);
  if (i + 1 == state.x.size()) return 0.0;
  return m.GJ_N_m2 * (before_[i] / share_of_vertex(state.mesh, i) - m.born_twist_per_m);
}

double Spin::out_of_vertex(const Material& m, const State& state, std::size_t i) const noexcept {
  if (i + 1 == state.x.size()) return 0.0;
  if (held_[i]) return m.GJ_N_m2 * (2.0 * after_[i] * state.mesh.inv_rest[i] - m.born_twist_per_m);
  return i == 0 ? 0.0 : into_vertex(m, state, i);
}

void Spin::assemble(const Material& m, const State& state, double dt_s) noexcept {
  const Mesh& mesh = state.mesh;
  const std::size_t edges = state.x.size() - 1;
  const double implicit = dt_s * (dt_s + m.bend_tau_s);
  const bool shaped = m.has_shape();
  double into = out_of_vertex(m, state, 0);
  for (std::size_t j = 0; j < edges; ++j) {
    const double next = into_vertex(m, state, j + 1);
    diag_[j] = inertia(m, mesh.rest[j]) * (1.0 + m.drag_per_s * dt_s);
    rhs_[j] = inertia(m, mesh.rest[j]) * rate_[j] + dt_s * (next - into);
    const double half = implicit * m.GJ_N_m2 * 2.0 * mesh.inv_rest[j];
    if (held_[j]) diag_[j] += half, rhs_[j] -= half * drift_after_[j];
    if (held_[j + 1]) diag_[j] += half, rhs_[j] += half * drift_before_[j + 1];
    into = out_of_vertex(m, state, j + 1);
    torque_[j] = 0.0;
  }
  for (std::size_t i = 1; i < edges; ++i) {
    const double k = held_[i] ? 0.0 : implicit * m.GJ_N_m2 / share_of_vertex(mesh, i);
    off_[i - 1] = -k;
    diag_[i - 1] += k, diag_[i] += k;
    if (!shaped) continue;
    const Vec q = mesh.weight[i] * state.elastic_bend(i);
    const double turn = 0.5 * dt_s * dot(q, across_[i]),
                 stiff = 0.5 * implicit * mesh.weight[i] * dot(across_[i], across_[i]);
    rhs_[i - 1] += turn, rhs_[i] += turn;
    diag_[i - 1] += stiff, diag_[i] += stiff;
  }
  eliminate();
  solve(rhs_);
}

// Eliminates the roll rates w from both ends of the thread: w_j = down_j w_{j+1} + .. and w_{j+1} = up_j w_j + ... So
// push() gets each neighbour's response by one multiplication.
void Spin::eliminate() noexcept {
  const std::size_t edges = tangent_.size() - 1;
  double d = diag_[0];
  for (std::size_t j = 0; j + 1 < edges; ++j) down_[j] = -off_[j] / d, d = diag_[j + 1] + off_[j] * down_[j];
  d = diag_[edges - 1];
  for (std::size_t j = edges - 1; j-- > 0;) up_[j] = -off_[j] / d, d = diag_[j] + off_[j] * up_[j];
  for (std::size_t j = 0; j < edges; ++j) {
    const double left = j > 0 ? off_[j - 1] * down_[j - 1] : 0.0, right = j + 1 < edges ? off_[j] * up_[j] : 0.0;
    answer_[j] = 1.0 / (diag_[j] + left + right);
  }
}

// Solves the tridiagonal system A rate_ = b with the factors that eliminate() has computed.
void Spin::solve(const std::vector<double>& b) noexcept {
  const std::size_t edges = tangent_.size() - 1;
  double carried = 0.0;
  for (std::size_t j = 0; j < edges; ++j) {
    rate_[j] = b[j] + carried;  // eliminated right-hand side
    if (j + 1 < edges) carried = down_[j] * rate_[j];
  }
  double next = 0.0;
  for (std::size_t j = edges; j-- > 0;) {
    const double pivot = diag_[j] + (j > 0 ? off_[j - 1] * down_[j - 1] : 0.0);
    next = rate_[j] / pivot + (j + 1 < edges ? down_[j] * next : 0.0);
    rate_[j] = next;
  }
}

void Spin::push(int segment, double torque_Nms, int first, int last) noexcept {
  const auto at = static_cast<std::size_t>(segment), low = static_cast<std::size_t>(first),
             high = static_cast<std::size_t>(last);
  torque_[at] += torque_Nms;
  const double own = answer_[at] * torque_Nms;
  rate_[at] += own;
  double w = own;
  for (std::size_t j = at; j-- > low;) rate_[j] += (w *= down_[j]);
  w = own;
  for (std::size_t j = at; j < high; ++j) rate_[j + 1] += (w *= up_[j]);
}

void Spin::save(int first, int last) noexcept {
  std::copy(rate_.begin() + first, rate_.begin() + last + 1, saved_rate_.begin() + first);
  std::copy(torque_.begin() + first, torque_.begin() + last + 1, saved_torque_.begin() + first);
}

void Spin::restore(int first, int last) noexcept {
  std::copy(saved_rate_.begin() + first, saved_rate_.begin() + last + 1, rate_.begin() + first);
  std::copy(saved_torque_.begin() + first, saved_torque_.begin() + last + 1, torque_.begin() + first);
}

void Spin::advance(const Material& material, State& state, Forces& forces, double dt_s) noexcept {
  const std::size_t edges = state.x.size() - 1;
  for (std::size_t j = 0; j < edges; ++j) rhs_[j] += torque_[j];
  solve(rhs_);
  for (std::size_t j = 0; j < edges; ++j) {
    const double angle = dt_s * rate_[j];
    rolled_[j] += angle;
    if (j > 0 && !held_[j]) before_[j] += angle;
    if (held_[j]) after_[j] += angle + dt_s * drift_after_[j];
    before_[j + 1] -= angle;
    if (held_[j + 1]) before_[j + 1] += dt_s * drift_before_[j + 1];
  }
  give_moments(material, state, forces);
  if (material.has_shape()) turn_born(material, state, dt_s);
}

double Spin::energy_J(const Material& m, const State& state) const noexcept {
  const std::size_t edges = state.x.size() - 1;
  double sum = 0.0;
  const auto spring = [&](double angle, double length) {
    const double strain = angle / length - m.born_twist_per_m;
    sum += 0.5 * m.GJ_N_m2 * strain * strain * length;
  };
  for (std::size_t i = 0; i <= edges; ++i) {
    if (held_[i]) {
      if (i > 0) spring(before_[i], 0.5 * state.mesh.rest[i - 1]);
      if (i < edges) spring(after_[i], 0.5 * state.mesh.rest[i]);
    } else if (i > 0 && i < edges) {
      spring(before_[i], share_of_vertex(state.mesh, i));
    }
  }
  for (std::size_t j = 0; j < edges; ++j) sum += 0.5 * inertia(m, state.mesh.rest[j]) * rate_[j] * rate_[j];
  const double locked = 0.5 * m.set_fraction * (1.0 - m.set_fraction);  // energy that plastic bends keep stored
  for (std::size_t i = 1; locked > 0.0 && i < edges; ++i) sum += locked * state.mesh.weight[i] * dot(set_[i], set_[i]);
  return sum;
}

}  // namespace ligature::physics::rod
