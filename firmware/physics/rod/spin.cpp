#include "firmware/physics/rod/spin.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "firmware/physics/rod/twist.hpp"

namespace ligature::physics::rod {
namespace {

Vec unit(Vec a) noexcept { return (1.0 / norm(a)) * a; }

Vec rolled(Vec director, Vec tangent, double angle) noexcept {
  return std::cos(angle) * director + std::sin(angle) * cross(tangent, director);
}

double angle_about(Vec axis, Vec from, Vec to) noexcept {
  return std::atan2(dot(axis, cross(from, to)), dot(from, to));
}

Vec edge(const State& state, std::size_t j) noexcept { return unit(state.x[j + 1] - state.x[j]); }

double inertia(const Material& m, double length) noexcept {
  return 0.5 * m.density_kg_per_m * m.radius_m * m.radius_m * length;
}

double share_of_vertex(const Mesh& mesh, std::size_t i) noexcept { return 0.5 * (mesh.rest[i - 1] + mesh.rest[i]); }

}  // namespace

void Spin::reserve(int nodes) {
  const auto n = static_cast<std::size_t>(nodes);
  for (auto* array : {&director_, &tangent_, &born_, &born_0_, &across_, &old_director_, &old_tangent_})
    array->assign(n, Vec{});
  for (auto* array :
       {&rate_, &rolled_, &middle_m_, &before_, &after_, &torque_, &diag_, &off_, &rhs_, &down_, &up_, &answer_,
        &saved_rate_, &saved_torque_, &drift_before_, &drift_after_, &old_rate_, &old_middle_m_})
    array->assign(n, 0.0);
  held_.assign(n, 0);
  was_held_.assign(n, 0);
}

void Spin::start(const Material& material, State& state) noexcept {
  const std::size_t edges = state.x.size() - 1;
  Vec t = edge(state, 0);
  Vec u = unit(cross(t, std::abs(t[2]) < 0.7 ? make(0, 0, 1) : make(0, 1, 0)));
  for (std::size_t j = 0; j < edges; ++j) {
    const Vec next = edge(state, j);
    u = transport(u, t, next);
    t = next;
    director_[j] = u, tangent_[j] = t;
    rate_[j] = rolled_[j] = 0.0;
    middle_m_[j] = 0.5 * (state.mesh.s[j] + state.mesh.s[j + 1]);
  }
  for (int h = 0; h < state.hold_count; ++h)
    if (state.holds[static_cast<std::size_t>(h)].holds_roll) attach(state, h);
  std::fill(born_.begin(), born_.end(), Vec{});
  if (material.born_curvature_per_m != 0.0) bear(material, state, false);
}

void Spin::attach(State& state, int hold) const noexcept {
  Hold& h = state.holds[static_cast<std::size_t>(hold)];
  const auto i = static_cast<std::size_t>(h.node);
  const std::size_t edges = state.x.size() - 1;
  Vec sum{};
  if (i > 0) sum += transport(rolled(director_[i - 1], tangent_[i - 1], rolled_[i - 1]), tangent_[i - 1], h.tangent);
  if (i < edges) sum += transport(rolled(director_[i], tangent_[i], rolled_[i]), tangent_[i], h.tangent);
  h.director = unit(sum - dot(sum, h.tangent) * h.tangent);
}

void Spin::before_fading(State& state, double fade) const noexcept {
  for (std::size_t i = 0; i < born_.size(); ++i) state.rest_bend[i] += (1.0 / fade - 1.0) * born_[i];
}

// Nodes moved along the thread: frames between the middles of the old segments turn evenly from one to the next.
void Spin::resample(const State& state) noexcept {
  const std::size_t edges = state.x.size() - 1;
  std::copy(director_.begin(), director_.end(), old_director_.begin());
  std::copy(tangent_.begin(), tangent_.end(), old_tangent_.begin());
  std::copy(rate_.begin(), rate_.end(), old_rate_.begin());
  std::copy(middle_m_.begin(), middle_m_.end(), old_middle_m_.begin());
  std::size_t k = 0;
  for (std::size_t j = 0; j < edges; ++j) {
    const double s = middle_m_[j] = 0.5 * (state.mesh.s[j] + state.mesh.s[j + 1]);
    while (k + 2 < edges && old_middle_m_[k + 1] < s) ++k;
    const std::size_t l = std::min(k + 1, edges - 1);
    const double gap = old_middle_m_[l] - old_middle_m_[k];
    const double share = gap > 0.0 ? std::clamp((s - old_middle_m_[k]) / gap, 0.0, 1.0) : 0.0;
    const Vec carried = transport(old_director_[k], old_tangent_[k], old_tangent_[l]);
    const double between = angle_about(old_tangent_[l], carried, old_director_[l]);
    tangent_[j] = unit((1.0 - share) * old_tangent_[k] + share * old_tangent_[l]);
    director_[j] = rolled(transport(old_director_[k], old_tangent_[k], tangent_[j]), tangent_[j], share * between);
    rate_[j] = (1.0 - share) * old_rate_[k] + share * old_rate_[l];
  }
}

// Directors go along with their tangents.
void Spin::follow(const State& state) noexcept {
  const std::size_t edges = state.x.size() - 1;
  for (std::size_t j = 0; j < edges; ++j) {
    const Vec now = edge(state, j);
    const Vec u = transport(director_[j], tangent_[j], now);
    director_[j] = unit(u - dot(u, now) * now);
    tangent_[j] = now;
  }
}

void Spin::update(const Material& material, State& state, Forces& forces, double tick_s, bool remeshed) noexcept {
  const std::size_t edges = state.x.size() - 1;
  for (std::size_t j = 0; j < edges; ++j)
    director_[j] = rolled(director_[j], tangent_[j], rolled_[j]), rolled_[j] = 0.0;
  if (remeshed) resample(state);
  follow(state);
  measure(state, tick_s, remeshed);
  give_moments(material, state, forces);
  if (material.born_curvature_per_m != 0.0) bear(material, state, remeshed);
}

void Spin::measure(const State& state, double tick_s, bool remeshed) noexcept {
  const std::size_t edges = state.x.size() - 1;
  std::swap(held_, was_held_);
  std::fill(held_.begin(), held_.end(), char{0});
  for (int h = 0; h < state.hold_count; ++h) {
    const Hold& hold = state.holds[static_cast<std::size_t>(h)];
    if (hold.node >= 0 && hold.holds_roll)
      measure_hold(state, hold, tick_s, remeshed || !was_held_[static_cast<std::size_t>(hold.node)]);
  }
  for (std::size_t i = 1; i < edges; ++i) {
    if (held_[i]) continue;
    before_[i] = angle_about(tangent_[i], transport(director_[i - 1], tangent_[i - 1], tangent_[i]), director_[i]);
    after_[i] = 0.0;
  }
}

// The angles jump by what the hold was turned; they are let grow by that in the course of the tick.
void Spin::measure_hold(const State& state, const Hold& hold, double tick_s, bool fresh) noexcept {
  const auto i = static_cast<std::size_t>(hold.node);
  held_[i] = 1;
  const auto note = [&](double& angle, double& drift, double now) {
    drift = fresh ? 0.0 : std::remainder(now - angle, 2.0 * std::numbers::pi) / tick_s;
    if (fresh) angle = now;
  };
  if (i > 0)
    note(before_[i], drift_before_[i],
         angle_about(hold.tangent, transport(director_[i - 1], tangent_[i - 1], hold.tangent), hold.director));
  if (i + 1 < state.x.size())
    note(after_[i], drift_after_[i],
         angle_about(tangent_[i], transport(hold.director, hold.tangent, tangent_[i]), director_[i]));
}

void Spin::give_moments(const Material& material, const State& state, Forces& forces) const noexcept {
  const std::size_t edges = state.x.size() - 1;
  for (std::size_t i = 0; i <= edges; ++i) {
    const double share = i == 0 || i == edges ? 1.0 : 0.5;  // an end has one side only
    forces.twist_moment[i] = share * (into_vertex(material, state, i) + out_of_vertex(material, state, i));
  }
}

// Twisting moment on the near side of vertex i, that of segment i - 1, and on its far side.
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

// Where the thread would lie without stress, for every vertex: State::rest_bend gets the difference to before.
void Spin::bear(const Material& material, State& state, bool keep_rest) noexcept {
  const std::size_t edges = state.x.size() - 1;
  for (std::size_t i = 1; i < edges; ++i) {
    const Vec t = unit(tangent_[i - 1] + tangent_[i]), sum = director_[i - 1] + director_[i];
    const Vec d = unit(sum - dot(sum, t) * t);
    const double size = 2.0 * std::sin(0.5 * material.born_curvature_per_m * share_of_vertex(state.mesh, i));
    const Vec born = size * d;
    if (!keep_rest) state.rest_bend[i] += born - born_[i];
    born_[i] = born_0_[i] = born;
    across_[i] = size * cross(t, d);
  }
}

// The same for what was rolled within the tick.
void Spin::turn_born(State& state) noexcept {
  const std::size_t edges = state.x.size() - 1;
  for (std::size_t i = 1; i < edges; ++i) {
    const double a = 0.5 * (rolled_[i - 1] + rolled_[i]);
    const Vec born = (1.0 - 0.5 * a * a) * born_0_[i] + a * across_[i];
    state.rest_bend[i] += born - born_[i];
    born_[i] = born;
  }
}

void Spin::assemble(const Material& m, const State& state, const Forces& forces, double dt_s) noexcept {
  const Mesh& mesh = state.mesh;
  const std::size_t edges = state.x.size() - 1;
  const double implicit = dt_s * (dt_s + m.bend_tau_s);
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
    if (m.born_curvature_per_m == 0.0) continue;
    const Vec q = mesh.weight[i] * (forces.tangent[i] - forces.tangent[i - 1] - state.rest_bend[i]);
    const double turn = 0.5 * dt_s * dot(q, across_[i]),
                 stiff = 0.5 * implicit * mesh.weight[i] * dot(born_0_[i], born_0_[i]);
    rhs_[i - 1] += turn, rhs_[i] += turn;
    diag_[i - 1] += stiff, diag_[i] += stiff;
  }
  // Elimination from both ends: w_j = down_j w_{j+1} + .. and w_{j+1} = up_j w_j + .., so that the answer to a torque
  // spreads by products.
  double d = diag_[0];
  for (std::size_t j = 0; j + 1 < edges; ++j) down_[j] = -off_[j] / d, d = diag_[j + 1] + off_[j] * down_[j];
  d = diag_[edges - 1];
  for (std::size_t j = edges - 1; j-- > 0;) up_[j] = -off_[j] / d, d = diag_[j] + off_[j] * up_[j];
  for (std::size_t j = 0; j < edges; ++j) {
    const double left = j > 0 ? off_[j - 1] * down_[j - 1] : 0.0, right = j + 1 < edges ? off_[j] * up_[j] : 0.0;
    answer_[j] = 1.0 / (diag_[j] + left + right);
  }
  solve(rhs_);
}

// rate_ = A^-1 b by the factors of assemble().
void Spin::solve(const std::vector<double>& b) noexcept {
  const std::size_t edges = tangent_.size() - 1;
  double carried = 0.0;
  for (std::size_t j = 0; j < edges; ++j) {
    rate_[j] = b[j] + carried;  // right-hand side after elimination
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
  if (material.born_curvature_per_m != 0.0) turn_born(state);
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
  return sum;
}

}  // namespace ligature::physics::rod
