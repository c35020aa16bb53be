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

void ContactSet::collect_thread(const State& state, double travel_m, double look_m, double near_m, double dt_s,
                                double mu, ContactReport& report) noexcept {
  for (auto& pair : pairs) {
    if (pair.due - 2.0 * travel_m > look_m) {
      pair.impulse = Vec{};
      continue;
    }
    const auto a = static_cast<std::size_t>(pair.a), b = static_cast<std::size_t>(pair.b);
    const Closest c = closest(state.x[a], state.x[a + 1], state.x[b], state.x[b + 1]);
    const double distance = std::sqrt(c.distance2), gap = distance - pair.reach_m;
    pair.due = gap + 2.0 * travel_m;
    report.min_gap_m = std::min(report.min_gap_m, gap);
    // Far enough for one substep at today's relative speed (half the broad bound of look_m is usually wasted).
    const Vec u = (1.0 - c.t) * state.v[b] + c.t * state.v[b + 1] - (1.0 - c.s) * state.v[a] - c.s * state.v[a + 1];
    if (gap > near_m + 2.0 * dt_s * norm(u)) {
      pair.impulse = Vec{};
      if (watched_.size() < watched_.capacity()) {
        watched_.push_back({pair.a, pair.b, distance});
      } else {
        report.cap_hit = true;
      }
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
                              ContactReport& report) noexcept {
  const std::size_t n = state.x.size();
  const double reach = body.radius_m + radius_m;
  const Vec middle = 0.5 * (body.p0 + body.p1);
  const double half = 0.5 * norm(body.p1 - body.p0);
  for (std::size_t j = 0; j + 1 < n; ++j) {
    Vec& keep = body_impulse[static_cast<std::size_t>(index) * n + j];
    const Vec off = 0.5 * (state.x[j] + state.x[j + 1]) - middle;
    const double far = half + state.mesh.rest[j] + reach + look_m;  // generous: half a segment may be stretched
    if (dot(off, off) > far * far) {
      keep = Vec{};
      continue;
    }
    const Closest c = closest(body.p0, body.p1, state.x[j], state.x[j + 1]);
    const double distance = std::sqrt(c.distance2), gap = distance - reach;
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
}

}  // namespace ligature::physics::rod
