// Material frames of the segments: initialisation, and once per tick their transport with the thread and the angles
// between them.

#include <algorithm>
#include <cmath>
#include <numbers>

#include "firmware/physics/rod/model/spin.hpp"
#include "firmware/physics/rod/model/twist.hpp"

namespace ligature::physics::rod {

void Spin::reserve(int nodes) {
  const auto n = static_cast<std::size_t>(nodes);
  for (auto* array :
       {&director_, &tangent_, &normal_, &binormal_, &born_, &across_, &set_, &old_director_, &old_tangent_, &old_set_})
    array->assign(n, Vec{});
  for (auto* array : {&rate_,         &rolled_,      &middle_m_,  &before_, &after_,    &torque_,      &diag_,
                      &off_,          &rhs_,         &down_,      &up_,     &answer_,   &saved_rate_,  &saved_torque_,
                      &drift_before_, &drift_after_, &born_size_, &limit2_, &old_rate_, &old_middle_m_})
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
    if (state.holds[h].holds_roll) attach(state, h);
  std::fill(set_.begin(), set_.end(), Vec{});
  if (material.has_shape()) bear(material, state, false);
}

void Spin::attach(State& state, int hold) const noexcept {
  Hold& h = state.holds[hold];
  const auto i = static_cast<std::size_t>(h.node);
  const std::size_t edges = state.x.size() - 1;
  Vec sum{};
  if (i > 0) sum += transport(rolled(director_[i - 1], tangent_[i - 1], rolled_[i - 1]), tangent_[i - 1], h.tangent);
  if (i < edges) sum += transport(rolled(director_[i], tangent_[i], rolled_[i]), tangent_[i], h.tangent);
  h.director = unit(sum - dot(sum, h.tangent) * h.tangent);
}

void Spin::before_fading(State& state, std::span<const double> fade) const noexcept {
  for (std::size_t i = 0; i < born_.size(); ++i) state.rest_bend[i] += (1.0 / fade[i] - 1.0) * born_[i];
}

// After remeshing: interpolates directors and roll rates of the new segments between the midpoints of the old ones.
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

// Parallel transport of the directors to the new tangents.
void Spin::follow(const State& state) noexcept {
  const std::size_t edges = state.x.size() - 1;
  for (std::size_t j = 0; j < edges; ++j) {
    const Vec now = edge(state, j);
    const Vec u = transport(director_[j], tangent_[j], now);
    director_[j] = unit(u - dot(u, now) * now);
    tangent_[j] = now;
  }
}

void Spin::update(const Material& material, State& state, Forces& forces, double tick_s, bool remeshed,
                  bool once) noexcept {
  const std::size_t edges = state.x.size() - 1;
  if (material.sets()) set_to_material();
  for (std::size_t j = 0; j < edges; ++j)
    director_[j] = rolled(director_[j], tangent_[j], rolled_[j]), rolled_[j] = 0.0;
  if (remeshed) {
    resample(state);
    if (material.sets()) resample_set(state.mesh.s[edges]);
  }
  follow(state);
  measure(state, tick_s, remeshed);
  if (material.has_shape()) bear(material, state, remeshed);
  if (!once) return give_moments(material, state, forces);
  assemble(material, state, tick_s);
  advance(material, state, forces, tick_s);
}

void Spin::measure(const State& state, double tick_s, bool remeshed) noexcept {
  const std::size_t edges = state.x.size() - 1;
  std::swap(held_, was_held_);
  std::fill(held_.begin(), held_.end(), char{0});
  for (const Hold& hold : state.slots()) {
    if (hold.node >= 0 && hold.holds_roll) measure_hold(state, hold, tick_s, remeshed || !was_held_[hold.node]);
  }
  for (std::size_t i = 1; i < edges; ++i) {
    if (held_[i]) continue;
    before_[i] = angle_about(tangent_[i], transport(director_[i - 1], tangent_[i - 1], tangent_[i]), director_[i]);
    after_[i] = 0.0;
  }
}

// Measures the twist angles between a hold and its segments. If the hold has turned since the last tick, the angles do
// not jump, but change at a constant rate during this tick.
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

// Computes every vertex's stress-free bend from rest curvature and plastic bends, and adds its change to
// State::rest_bend.
void Spin::bear(const Material& material, State& state, bool keep_rest) noexcept {
  const std::size_t edges = state.x.size() - 1;
  for (std::size_t i = 1; i < edges; ++i) {
    const Vec t = unit(tangent_[i - 1] + tangent_[i]), sum = director_[i - 1] + director_[i];
    normal_[i] = unit(sum - dot(sum, t) * t);
    binormal_[i] = cross(t, normal_[i]);
    born_size_[i] = 2.0 * std::sin(0.5 * material.born_curvature_per_m * share_of_vertex(state.mesh, i));
  }
  if (material.sets()) set_to_world(material, state.mesh);
  for (std::size_t i = 1; i < edges; ++i) {
    const Vec born = shape_of(material, i);
    if (!keep_rest) state.rest_bend[i] += born - born_[i];
    born_[i] = born;
  }
}

Vec Spin::shape_of(const Material& material, std::size_t i) noexcept {
  const Vec set = material.set_fraction * set_[i];
  const double along = born_size_[i] + dot(set, normal_[i]), aside = dot(set, binormal_[i]);
  across_[i] = along * binormal_[i] - aside * normal_[i];
  return along * normal_[i] + aside * binormal_[i];
}

// After the segments have rolled for dt_s: rolls the vertices' directors (normal_, binormal_) and stress-free bends
// too, and adds the change of these bends to State::rest_bend.
void Spin::turn_born(const Material& material, State& state, double dt_s) noexcept {
  const std::size_t edges = state.x.size() - 1;
  for (std::size_t i = 1; i < edges; ++i) {
    const double a = 0.25 * dt_s * (rate_[i - 1] + rate_[i]);  // half the angle, used in place of its tangent
    const double sine = 2.0 * a / (1.0 + a * a), cosine = 1.0 - a * sine;
    const Vec d = normal_[i], b = binormal_[i];
    normal_[i] = cosine * d + sine * b;
    binormal_[i] = cosine * b - sine * d;
    if (material.sets()) set_[i] = dot(set_[i], d) * normal_[i] + dot(set_[i], b) * binormal_[i];
    const Vec born = shape_of(material, i);
    state.rest_bend[i] += born - born_[i];
    born_[i] = born;
  }
}

}  // namespace ligature::physics::rod
