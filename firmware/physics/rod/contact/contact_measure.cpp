// Measures the distances of segment pairs of the thread, four at a time, and makes contacts of the near ones.

#include <algorithm>
#include <array>
#include <cmath>

#include "firmware/physics/closest.hpp"
#include "firmware/physics/rod/contact/contact_set.hpp"
#include "firmware/physics/rod/contact/four_segments.hpp"
#include "firmware/physics/rod/contact/smooth.hpp"
#include "firmware/physics/rod/tuning.hpp"

namespace ligature::physics::rod {
namespace {

/// Replaces the closest points s, t by the points at which the pair's impulse acts (touch.hpp).
void press(Candidate& pair, const State& state, double& s, double& t) noexcept {
  const Mesh& mesh = state.mesh;
  const std::int32_t a = pair.a, b = pair.b;
  const double at_a = mesh.s[a] + s * mesh.rest[a], at_b = mesh.s[b] + t * mesh.rest[b];
  pair.next = {at_a, at_b};
  if (dot(pair.impulse, pair.impulse) == 0.0) return;
  const Vec e = state.x[a + 1] - state.x[a], f = state.x[b + 1] - state.x[b];
  pair.next = pair.touch;
  pair.next.follow(at_a, at_b, dot(e, f) / std::max(std::sqrt(dot(e, e) * dot(f, f)), 1e-300));
  s = clamp01((pair.next.a - mesh.s[a]) * mesh.inv_rest[a]);
  t = clamp01((pair.next.b - mesh.s[b]) * mesh.inv_rest[b]);
}

}  // namespace

// Finds the pairs that must be measured in this substep, and charges the work of measuring them. All other pairs cannot
// touch within the substep, even at twice the present speed. @return false if too little work is left.
bool ContactSet::find_due(const Motion& motion, double dt_s, Work& work) noexcept {
  awake_.clear();
  for (auto* list : {&due_, &close_, &far_}) list->clear();
  bent_ = {1 << 30, -1};
  if (price::kCheck * static_cast<long>(groups.size()) > work.left()) return false;
  work.spend(price::kCheck * static_cast<long>(groups.size()));
  long listed = 0;
  for (std::size_t k = 0; k < groups.size(); ++k) {
    const PairGroup& g = groups[k];
    if (g.due - motion.gone_of_blocks(g.p, g.q) > 2.0 * dt_s * motion.rate_of_blocks(g.p, g.q)) continue;
    awake_.push_back(static_cast<std::int32_t>(k));
    listed += g.last - g.first;
  }
  if (price::kCheck * listed > work.left()) return false;
  work.spend(price::kCheck * listed);
  for (const auto g : awake_) {
    for (std::int32_t k = groups[g].first; k < groups[g].last; ++k) {
      Candidate& pair = pairs[k];
      const double gap_m = pair.due - motion.gone(pair.a, pair.b);
      if (gap_m > pair.near_m + 2.0 * dt_s * motion.rate(pair.a, pair.b)) {
        pair.impulse = Vec{};
      } else {
        const bool close = gap_m < pair.near_m && pair.bulge_m > 0.0;
        (close ? close_ : far_).push_back(static_cast<std::int32_t>(due_.size()));
        if (close) bent_ = {std::min(bent_.first, pair.a), std::max(bent_.last, pair.b + 1)};
        due_.push_back(k);
      }
    }
  }
  const auto fours = [](const std::vector<std::int32_t>& list) { return static_cast<long>(list.size() + 3) / 4; };
  const long cost = (price::kPlace + price::kTake + price::kGuard) * static_cast<long>(due_.size()) +
                    price::kMeasure * fours(far_) + (price::kMeasure + price::kSmooth) * fours(close_) +
                    price::kCorner * std::max(0L, static_cast<long>(bent_.last - bent_.first));
  if (cost > work.left()) return false;
  work.spend(cost);
  return true;
}

// Computes closest points and distances of four pairs at once; `places` are the indices of these pairs in due_.
template <bool Smooth>
void ContactSet::measure(const std::int32_t* places, const State& state) noexcept {
  const auto pair = [&](std::size_t l) -> const Candidate& { return pairs[due_[places[l]]]; };
  const auto segments = [&](std::int32_t Candidate::*end) {
    return std::array<std::size_t, 4>{static_cast<std::size_t>(pair(0).*end), static_cast<std::size_t>(pair(1).*end),
                                      static_cast<std::size_t>(pair(2).*end), static_cast<std::size_t>(pair(3).*end)};
  };
  const FourSegments a(segments(&Candidate::a), state.x.data()), b(segments(&Candidate::b), state.x.data());
  Closest<Vecs> c = closest_along(a.e, b.e, b.x - a.x);
  const Lanes chord = root(c.distance2);
  Lanes distance = chord;
  auto smooth = chord < Lanes{};
  if constexpr (Smooth) {
    const Lanes within = each([&](std::size_t l) { return pair(l).reach_m + pair(l).near_m + pair(l).bulge_m; });
    const Closest<Vecs> curves = closest_on_curves(a.smooth(state, corner_.data()), b.smooth(state, corner_.data()), c);
    const auto close = smooth = chord < within;
    c.s = close ? curves.s : c.s, c.t = close ? curves.t : c.t;
    c.between.x = close ? curves.between.x : c.between.x;
    c.between.y = close ? curves.between.y : c.between.y;
    c.between.z = close ? curves.between.z : c.between.z;
    distance = close ? root(curves.distance2) : chord;
  }
  for (int l = 0; l < 4; ++l) {
    Measured& m = measured_[places[l]];
    m = {make(c.between.x[l], c.between.y[l], c.between.z[l]), c.s[l], c.t[l], distance[l], chord[l], smooth[l] != 0};
  }
}

// Computes the corner vectors k_i of the smooth curve (smooth.hpp) at the nodes of the close pairs. All of them use the
// same distance of touch, because every close pair touches at the diameter.
void ContactSet::bend(const State& state) noexcept {
  if (close_.empty()) return;
  const double diameter_m = pairs[due_[close_[0]]].reach_m;
  const std::int32_t first = std::max(bent_.first, 1), last = std::min(bent_.last, state.nodes() - 2);
  for (std::int32_t i = first; i <= last; ++i) SmoothSegment::corner(state, i, diameter_m, corner_[i], share_[i]);
}

// Changes the nodes and weights of a contact so that it acts on the smooth curve at parameter s, instead of on the
// chord that begins at node[at].
void ContactSet::bend_row(Contact& c, int at, double s, const State& state) const noexcept {
  const std::int32_t j = c.node[at];
  const double side = at == 0 ? -0.25 : 0.25, h_before = state.cut_before[j], h_after = state.cut_after[j];
  const double p = larger(1.0 - s / h_before, 0.0), q = larger(1.0 - (1.0 - s) / h_after, 0.0);
  const auto add = [&](std::int32_t node, double w) {
    c.node[c.count] = node, c.w[c.count] = w;
    ++c.count;
    c.first = std::min(c.first, node), c.last = std::max(c.last, node);
  };
  if (const double cut = side * p * p * share_[j]; cut != 0.0) {
    const double on = cut * h_before, off = cut * state.cut_after[j - 1];
    c.w[at] -= on + off, c.w[at + 1] += on;
    add(c.node[at] - 1, off);
  }
  if (const double cut = side * q * q * share_[j + 1]; cut != 0.0) {
    const double on = cut * h_after, off = cut * state.cut_before[j + 1];
    c.w[at + 1] -= on + off, c.w[at] += on;
    add(c.node[at] + 2, off);
  }
}

bool ContactSet::collect_thread(const State& state, const Motion& motion, double dt_s, double mu, Work& work,
                                ContactReport& report) noexcept {
  if (!find_due(motion, dt_s, work)) return false;
  bend(state);
  Pieces pieces(work.time());
  const auto by_fours = [&](std::vector<std::int32_t>& list, long cost, auto measure_four) {
    while (list.size() % 4 != 0) list.push_back(list.back());
    for (std::size_t k = 0; k < list.size(); k += 4) {
      if (!pieces.allow(cost)) return false;
      measure_four(list.data() + k);
    }
    return true;
  };
  const auto smooth = [&](const std::int32_t* places) { measure<true>(places, state); };
  const auto straight = [&](const std::int32_t* places) { measure<false>(places, state); };
  if (!by_fours(close_, price::kMeasure + price::kSmooth, smooth) || !by_fours(far_, price::kMeasure, straight))
    return false;
  if (!find_near(state, dt_s, pieces) || !choose_near(work, pieces)) return false;
  std::size_t next = 0;
  for (const auto index : awake_) {
    PairGroup& group = groups[index];
    bool touches = false;
    if (!pieces.allow((price::kTake + price::kGuard) * (group.last - group.first))) return false;
    for (; next < due_.size() && due_[next] < group.last; ++next) {
      Candidate& pair = pairs[due_[next]];
      const Measured& m = measured_[next];
      pair.due = std::min(m.distance_m, m.chord_m - pair.bulge_m) - pair.reach_m + motion.gone(pair.a, pair.b);
      touches |= take(pair, m, state, mu, report);
    }
    group.due = touches ? PairGroup::kAtOnce : 1e300;
    for (std::int32_t k = group.first; !touches && k < group.last; ++k) {
      const Candidate& pair = pairs[k];
      group.due = std::min(group.due, pair.due - pair.near_m);
    }
  }
  return true;
}

bool ContactSet::take(Candidate& pair, const Measured& m, const State& state, double mu,
                      ContactReport& report) noexcept {
  const double gap = m.distance_m - pair.reach_m;
  double s = m.s, t = m.t;
  report.min_gap_m = std::min(report.min_gap_m, gap);
  const bool full = contacts_.size() >= static_cast<std::size_t>(kMaxContacts);
  if (full || !m.touches) {
    report.rows_left_out += full;
    pair.impulse = Vec{};
    watched_.push_back({pair.a, pair.b, m.chord_m});  // never allocates: reserved for all pairs
    return false;
  }
  press(pair, state, s, t);
  Contact* const made = add(gap, pair.reach_m, mu, pair.impulse, pair.stuck);
  if (made == nullptr) return pair.impulse = Vec{}, true;  // safe_fraction() is then 0: nothing moves
  Contact& contact = *made;
  contact.node[0] = pair.a, contact.node[1] = pair.a + 1, contact.node[2] = pair.b, contact.node[3] = pair.b + 1;
  contact.w[0] = s - 1.0, contact.w[1] = -s, contact.w[2] = 1.0 - t, contact.w[3] = t;
  contact.first = contact.node[0], contact.last = contact.node[3];
  if (m.smooth) bend_row(contact, 0, s, state), bend_row(contact, 2, t, state);
  contact.n = m.distance_m > 1e-12 ? (1.0 / m.distance_m) * m.between : make(0, 0, 1);
  contact.distance_m = m.chord_m;
  contact.pair = &pair;
  return true;
}

}  // namespace ligature::physics::rod
