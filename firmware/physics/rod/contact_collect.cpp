// What touches what, and how near: the geometry half of ContactSet.

#include <algorithm>

#include "firmware/physics/rod/closest.hpp"
#include "firmware/physics/rod/contact.hpp"

namespace ligature::physics::rod {

void ContactSet::add(const Contact& contact, ContactReport& report) noexcept {
  if (contacts_.size() >= static_cast<std::size_t>(kMaxContacts)) {
    report.cap_hit = true;
    return;
  }
  contacts_.push_back(contact);
  for (int k = 0; k < contact.count; ++k) {
    window_first_ = std::min(window_first_, static_cast<int>(contact.node[k]));
    window_last_ = std::max(window_last_, static_cast<int>(contact.node[k]));
  }
}

void ContactSet::collect_thread(const State& state, const Motion& motion, double near_m, double dt_s, double mu,
                                ContactReport& report) noexcept {
  for (auto& pair : pairs) {
    const auto a = static_cast<std::size_t>(pair.a), b = static_cast<std::size_t>(pair.b);
    const double gone = motion.gone(a, b);
    if (pair.due - gone > near_m + 2.0 * dt_s * motion.rate(a, b)) {  // cannot meet, even at twice today's speed
      pair.impulse = Vec{};
      continue;
    }
    const Closest c = closest(state.x[a], state.x[a + 1], state.x[b], state.x[b + 1]);
    const double distance = std::sqrt(c.distance2), gap = distance - pair.reach_m;
    pair.due = gap + gone;
    report.min_gap_m = std::min(report.min_gap_m, gap);
    // Far enough for one substep at today's relative speed (half the bound of above is usually wasted).
    const Vec u = (1.0 - c.t) * state.v[b] + c.t * state.v[b + 1] - (1.0 - c.s) * state.v[a] - c.s * state.v[a + 1];
    const bool full = contacts_.size() >= static_cast<std::size_t>(kMaxContacts);
    if (full || gap > near_m + 2.0 * dt_s * norm(u)) {
      report.cap_hit |= full;  // without room for a contact the guard still holds the pair
      pair.impulse = Vec{};
      watched_.push_back({pair.a, pair.b, distance});  // has room for every pair
      continue;
    }
    pair.s_a = state.mesh.s[a] + c.s * state.mesh.rest[a];
    pair.s_b = state.mesh.s[b] + c.t * state.mesh.rest[b];
    Contact contact;
    contact.node[0] = pair.a, contact.node[1] = pair.a + 1, contact.node[2] = pair.b, contact.node[3] = pair.b + 1;
    contact.w[0] = c.s - 1.0, contact.w[1] = -c.s, contact.w[2] = 1.0 - c.t, contact.w[3] = c.t;
    contact.n = distance > 1e-12 ? (1.0 / distance) * c.between : make(0, 0, 1);
    contact.gap_m = gap;
    contact.reach_m = pair.reach_m;
    contact.mu = mu;
    contact.p = pair.impulse;
    contact.keep = &pair.impulse;
    add(contact, report);
  }
}

void ContactSet::collect_floor(const State& state, double floor_m, double radius_m, double look_m, double mu,
                               ContactReport& report) noexcept {
  for (std::size_t i = 0; i < state.x.size(); ++i) {
    const double gap = state.x[i][2] - floor_m - radius_m;
    if (gap > look_m) {
      floor_impulse[i] = Vec{};
      continue;
    }
    Contact contact;
    contact.count = 1;
    contact.node[0] = static_cast<std::int32_t>(i);
    contact.w[0] = 1.0;
    contact.n = make(0, 0, 1);
    contact.gap_m = gap;
    contact.reach_m = radius_m;
    contact.mu = mu;
    contact.p = floor_impulse[i];
    contact.keep = &floor_impulse[i];
    add(contact, report);
  }
}

void ContactSet::collect_body(const State& state, const Body& body, int index, double radius_m, double look_m,
                              double travel_m, ContactReport& report) noexcept {
  double& due = body_due_[static_cast<std::size_t>(index)];
  if (due - travel_m > look_m) return;
  const std::size_t n = state.x.size();
  const double reach = body.radius_m + radius_m;
  const Vec middle = 0.5 * (body.p0 + body.p1);
  const double half = 0.5 * norm(body.p1 - body.p0);
  double nearest2 = 1e300, longest = 0.0, least = 1e150;
  for (std::size_t j = 0; j + 1 < n; ++j) {
    Vec& keep = body_impulse[static_cast<std::size_t>(index) * n + j];
    const Vec off = 0.5 * (state.x[j] + state.x[j + 1]) - middle;
    const double within = half + state.mesh.rest[j] + reach;  // generous: half a segment may be stretched
    const double far = within + look_m, off2 = dot(off, off);
    if (off2 > far * far) {
      keep = Vec{};
      nearest2 = std::min(nearest2, off2);
      longest = std::max(longest, within);
      continue;
    }
    const Closest c = closest(body.p0, body.p1, state.x[j], state.x[j + 1]);
    const double distance = std::sqrt(c.distance2), gap = distance - reach;
    least = std::min(least, gap);
    if (gap > look_m) {
      keep = Vec{};
      continue;
    }
    Contact contact;
    contact.count = 2;
    contact.node[0] = static_cast<std::int32_t>(j), contact.node[1] = static_cast<std::int32_t>(j + 1);
    contact.w[0] = 1.0 - c.t, contact.w[1] = c.t;
    contact.n = distance > 1e-12 ? (1.0 / distance) * c.between : make(0, 0, 1);
    contact.surface = body.velocity;
    contact.gap_m = gap;
    contact.reach_m = reach;
    contact.mu = body.friction;
    contact.p = keep;
    contact.keep = &keep;
    add(contact, report);
  }
  due = std::min(least, std::sqrt(nearest2) - longest) + travel_m;
}

}  // namespace ligature::physics::rod
