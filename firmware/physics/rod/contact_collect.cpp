// What touches what, and how near: the geometry half of ContactSet.

#include <algorithm>

#include "firmware/physics/rod/closest.hpp"
#include "firmware/physics/rod/contact.hpp"
#include "firmware/physics/rod/smooth.hpp"

namespace ligature::physics::rod {

namespace {

constexpr double kClose = 2.0;  // near_m's: what is nearer than that is measured between smooth curves

Contact contact_of(const Candidate& pair, const Closest& c, double distance, double mu) noexcept {
  Contact contact;
  contact.node[0] = pair.a, contact.node[1] = pair.a + 1, contact.node[2] = pair.b, contact.node[3] = pair.b + 1;
  contact.w[0] = c.s - 1.0, contact.w[1] = -c.s, contact.w[2] = 1.0 - c.t, contact.w[3] = c.t;
  contact.n = distance > 1e-12 ? (1.0 / distance) * c.between : make(0, 0, 1);
  contact.gap_m = distance - pair.reach_m;
  contact.reach_m = pair.reach_m;
  contact.mu = mu;
  contact.p = pair.impulse;
  return contact;
}

/// Closest points become those at which the pair's impulse acts.
void press(Candidate& pair, const State& state, Closest& c) noexcept {
  const auto a = static_cast<std::size_t>(pair.a), b = static_cast<std::size_t>(pair.b);
  const Mesh& mesh = state.mesh;
  const double at_a = mesh.s[a] + c.s * mesh.rest[a], at_b = mesh.s[b] + c.t * mesh.rest[b];
  if (dot(pair.impulse, pair.impulse) == 0.0) return pair.next.begin(at_a, at_b);
  pair.next = pair.touch;
  pair.next.follow(at_a, at_b);
  c.s = std::clamp((pair.next.a - mesh.s[a]) / mesh.rest[a], 0.0, 1.0);
  c.t = std::clamp((pair.next.b - mesh.s[b]) / mesh.rest[b], 0.0, 1.0);
}

/// The less, the more a contact wants to be solved: those that carry load first, then the nearest.
double urgency(const Contact& c) noexcept { return c.gap_m - (dot(c.p, c.p) > 0.0 ? c.reach_m : 0.0); }

int lowest_node(const Contact& c) noexcept { return std::min(c.node[0], c.node[2]); }
int highest_node(const Contact& c) noexcept { return std::max(c.node[1], c.node[3]); }

}  // namespace

void ContactSet::add(const Contact& contact) noexcept {
  if (contacts_.size() == contacts_.capacity()) {
    overflow_ = true;
    *contact.keep = Vec{};
    return;
  }
  contacts_.push_back(contact);
  Contact& added = contacts_.back();
  for (int k = added.count; k < 4; ++k) added.node[k] = added.node[0];  // weight zero
}

// Groups that may hold a pair that is due, and those pairs, which is paid for here. The other pairs cannot meet, even
// at twice today's speed. @return false when there is not work enough.
bool ContactSet::find_due(const Motion& motion, double dt_s, Work& work) noexcept {
  awake_.clear();
  due_.clear();
  if (price::kCheck * static_cast<long>(groups.size()) > work.left()) return false;
  work.spend(price::kCheck * static_cast<long>(groups.size()));
  long listed = 0;
  for (std::size_t k = 0; k < groups.size(); ++k) {
    const PairGroup& g = groups[k];
    const auto p = static_cast<std::size_t>(g.p), q = static_cast<std::size_t>(g.q);
    if (g.due - motion.gone_of_blocks(p, q) > 2.0 * dt_s * motion.rate_of_blocks(p, q)) continue;
    awake_.push_back(static_cast<std::int32_t>(k));
    listed += g.last - g.first;
  }
  if (price::kCheck * listed > work.left()) return false;
  work.spend(price::kCheck * listed);
  long close = 0;
  for (const auto g : awake_) {
    for (std::int32_t k = groups[static_cast<std::size_t>(g)].first; k < groups[static_cast<std::size_t>(g)].last;
         ++k) {
      Candidate& pair = pairs[static_cast<std::size_t>(k)];
      const auto a = static_cast<std::size_t>(pair.a), b = static_cast<std::size_t>(pair.b);
      if (pair.due - motion.gone(a, b) > pair.near_m + 2.0 * dt_s * motion.rate(a, b)) {
        pair.impulse = Vec{};
      } else {
        due_.push_back(k);
        close += pair.due - motion.gone(a, b) < kClose * pair.near_m;
      }
    }
  }
  const long cost = (price::kMeasure + price::kGuard) * static_cast<long>(due_.size()) + price::kSmooth * close;
  if (cost > work.left()) return false;
  work.spend(cost);
  return true;
}

bool ContactSet::collect_thread(const State& state, const Motion& motion, double dt_s, double mu, Work& work,
                                ContactReport& report) noexcept {
  if (!find_due(motion, dt_s, work)) return false;
  std::size_t next = 0;
  for (const auto index : awake_) {
    PairGroup& group = groups[static_cast<std::size_t>(index)];
    bool touches = false;
    for (; next < due_.size() && due_[next] < group.last; ++next) {
      touches |= measure(pairs[static_cast<std::size_t>(due_[next])], state, motion, dt_s, mu, report);
    }
    group.due = touches ? PairGroup::kAtOnce : 1e300;
    for (std::int32_t k = group.first; !touches && k < group.last; ++k) {
      const Candidate& pair = pairs[static_cast<std::size_t>(k)];
      group.due = std::min(group.due, pair.due - pair.near_m);
    }
  }
  return true;
}

bool ContactSet::measure(Candidate& pair, const State& state, const Motion& motion, double dt_s, double mu,
                         ContactReport& report) noexcept {
  const auto a = static_cast<std::size_t>(pair.a), b = static_cast<std::size_t>(pair.b);
  Closest c = closest(state.x[a], state.x[a + 1], state.x[b], state.x[b + 1]);
  const double chord = std::sqrt(c.distance2);
  double distance = chord;
  if (pair.bulge_m > 0.0 && chord - pair.bulge_m < pair.reach_m + kClose * pair.near_m) {
    c = closest(SmoothSegment(state, a, pair.reach_m), SmoothSegment(state, b, pair.reach_m), c);
    distance = std::sqrt(c.distance2);
  }
  const double gap = distance - pair.reach_m;
  pair.due = std::min(distance, chord - pair.bulge_m) - pair.reach_m + motion.gone(a, b);
  report.min_gap_m = std::min(report.min_gap_m, gap);
  // Far enough for one substep at today's relative speed (half the bound of above is usually wasted).
  const Vec u = (1.0 - c.t) * state.v[b] + c.t * state.v[b + 1] - (1.0 - c.s) * state.v[a] - c.s * state.v[a + 1];
  const bool full = contacts_.size() >= static_cast<std::size_t>(kMaxContacts);
  if (full || gap > pair.near_m + 2.0 * dt_s * norm(u)) {
    report.rows_left_out += full;
    pair.impulse = Vec{};
    watched_.push_back({pair.a, pair.b, chord});  // has room for every pair
    return false;
  }
  press(pair, state, c);
  Contact contact = contact_of(pair, c, distance, mu);
  contact.distance_m = chord;
  contact.keep = &pair.impulse;
  contact.pair = &pair;
  contact.stuck = &pair.stuck;
  add(contact);
  return true;
}

bool ContactSet::afford_world(int nodes, int bodies, const Work& work) noexcept {
  const long node = price::kWorldNode + price::kGuard, body = price::kWorldNode + price::kMeasure + price::kGuard;
  return (node + body * bodies) * nodes <= work.left();
}

ContactSet::Span ContactSet::span() const noexcept {
  Span span{1 << 30, -1};
  for (const auto& c : contacts_) {
    span.first = std::min(span.first, lowest_node(c));
    span.last = std::max(span.last, highest_node(c));
  }
  return span;
}

// Contacts become rows in the order in which they were found; those left out move behind them.
void ContactSet::choose_rows(int most, int widest, int nodes, ContactReport& report) noexcept {
  const std::size_t found = contacts_.size(), room = static_cast<std::size_t>(std::clamp(most, 0, kMaxContacts));
  double deepest = 1e300, cut = 1e300;
  int anchor = 0;
  gaps_.clear();
  for (const auto& c : contacts_) {
    gaps_.push_back(urgency(c));
    if (gaps_.back() < deepest) deepest = gaps_.back(), anchor = lowest_node(c);
  }
  if (room < found) {
    std::nth_element(gaps_.begin(), gaps_.begin() + static_cast<std::ptrdiff_t>(room), gaps_.end());
    cut = gaps_[room];
  }
  const Span all = span();
  const bool narrow = all.last - all.first >= widest;  // then: from the deepest contact's first node on
  rows_ = 0, window_first_ = nodes, window_last_ = -1;
  for (std::size_t k = 0; k < found; ++k) {
    Contact& c = contacts_[k];
    const bool outside = narrow && (lowest_node(c) < anchor || highest_node(c) >= anchor + widest);
    if (urgency(c) >= cut || static_cast<std::size_t>(rows_) >= room || outside) {
      c.p = Vec{};
      ++report.rows_left_out;
      continue;
    }
    window_first_ = std::min(window_first_, lowest_node(c));
    window_last_ = std::max(window_last_, highest_node(c));
    if (static_cast<int>(k) != rows_) std::swap(c, contacts_[static_cast<std::size_t>(rows_)]);
    ++rows_;
  }
  if (rows_ == 0) window_first_ = window_last_ = (nodes - 2) / 2;
  if (window_first_ == window_last_ && window_last_ + 1 < nodes) ++window_last_;
  if (window_first_ == window_last_) --window_first_;
}

void ContactSet::collect_floor(const State& state, double floor_m, double radius_m, double look_m, double mu,
                               Work& work) noexcept {
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
    contact.stuck = &floor_stuck[i];
    add(contact);
    work.spend(price::kGuard);
  }
  work.spend(price::kWorldNode * static_cast<long>(state.x.size()));
}

void ContactSet::collect_body(const State& state, const Body& body, int index, double radius_m, double look_m,
                              double travel_m, Work& work) noexcept {
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
    contact.stuck = &body_stuck[static_cast<std::size_t>(index) * n + j];
    add(contact);
    work.spend(price::kMeasure + price::kGuard);
  }
  work.spend(price::kWorldNode * static_cast<long>(n));
  due = std::min(least, std::sqrt(nearest2) - longest) + travel_m;
}

}  // namespace ligature::physics::rod
