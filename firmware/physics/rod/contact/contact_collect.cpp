// Collects contacts with floor and bodies, and chooses the contacts that are solved.

#include <algorithm>

#include "firmware/physics/closest.hpp"
#include "firmware/physics/rod/contact/contact_set.hpp"

namespace ligature::physics::rod {

namespace {

/// Sort key of a contact, smallest first. Contacts that carry load come before the others; within each of these two
/// groups, smaller gaps come first.
double urgency(const Contact& c) noexcept { return c.gap_m - (dot(c.p, c.p) > 0.0 ? c.reach_m : 0.0); }

}  // namespace

// Appends a contact whose other members the caller then fills in; this avoids a copy, because contacts are large.
// @param impulse, stuck storage between substeps. @return nullptr if there is no room.
Contact* ContactSet::add(double gap_m, double reach_m, double mu, Vec& impulse, char& stuck) noexcept {
  overflow_ |= contacts_.size() == contacts_.capacity();
  if (overflow_) return nullptr;
  Contact& made = contacts_.emplace_back();
  made.gap_m = gap_m, made.reach_m = reach_m, made.mu = mu, made.p = impulse;
  made.keep = &impulse, made.stuck = &stuck;
  return &made;
}

bool ContactSet::afford_world(int nodes, int bodies, const Work& work) noexcept {
  const long node = price::kWorldNode + price::kGuard, body = price::kWorldNode + price::kBody + price::kGuard;
  return (node + body * bodies) * nodes <= work.left();
}

ContactSet::Span ContactSet::span() const noexcept {
  Span span{1 << 30, -1};
  for (const auto& c : contacts_) {
    span.first = std::min(span.first, c.first);
    span.last = std::max(span.last, c.last);
  }
  return span;
}

// Chosen contacts (rows) keep the order in which they were collected; the others are moved behind them.
void ContactSet::choose_rows(int most, int widest, int nodes, ContactReport& report) noexcept {
  const std::size_t found = contacts_.size(), room = static_cast<std::size_t>(std::clamp(most, 0, kMaxContacts));
  double deepest = 1e300, cut = 1e300;
  int anchor = 0;
  gaps_.clear();
  for (const auto& c : contacts_) {
    gaps_.push_back(urgency(c));
    if (gaps_.back() < deepest) deepest = gaps_.back(), anchor = c.first;
  }
  if (room < found) {
    std::nth_element(gaps_.begin(), gaps_.begin() + static_cast<std::ptrdiff_t>(room), gaps_.end());
    cut = gaps_[room];
  }
  const Span all = span();
  const bool narrow = all.last - all.first >= widest;  // only contacts near the most urgent one
  rows_ = 0, window_first_ = nodes, window_last_ = -1;
  for (std::size_t k = 0; k < found; ++k) {
    Contact& c = contacts_[k];
    const bool outside = narrow && (c.first < anchor || c.last >= anchor + widest);
    if (urgency(c) >= cut || static_cast<std::size_t>(rows_) >= room || outside) {
      c.p = Vec{};
      ++report.rows_left_out;
      continue;
    }
    window_first_ = std::min(window_first_, c.first);
    window_last_ = std::max(window_last_, c.last);
    if (static_cast<int>(k) != rows_) std::swap(c, contacts_[rows_]);
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
    Contact* const made = gap > look_m ? nullptr : add(gap, radius_m, mu, floor_impulse[i], floor_stuck[i]);
    if (made == nullptr) {
      floor_impulse[i] = Vec{};
      continue;
    }
    Contact& contact = *made;
    contact.count = 1;
    contact.node[0] = contact.first = contact.last = static_cast<std::int32_t>(i);
    contact.w[0] = 1.0;
    contact.n = make(0, 0, 1);
    work.spend(price::kGuard);
  }
  work.spend(price::kWorldNode * static_cast<long>(state.x.size()));
}

template <bool Drum>
void ContactSet::collect_body(const State& state, const Body& body, int index, double radius_m, double look_m,
                              double travel_m, Work& work) noexcept {
  double& due = body_due_[index];
  if (due - travel_m > look_m) return;
  const std::size_t n = state.x.size();
  const double reach = body.radius_m + radius_m;
  const Vec middle = 0.5 * (body.p0 + body.p1);
  const double half = 0.5 * norm(body.p1 - body.p0);
  double nearest2 = 1e300, longest = 0.0, least = 1e150;
  for (std::size_t j = 0; j + 1 < n; ++j) {
    Vec& keep = body_impulse[index * n + j];
    const Vec off = 0.5 * (state.x[j] + state.x[j + 1]) - middle;
    const double within = half + state.mesh.rest[j] + reach;  // half a rest length would do without stretch
    const double far = within + look_m, off2 = dot(off, off);
    if (off2 > far * far) {
      keep = Vec{};
      nearest2 = std::min(nearest2, off2);
      longest = std::max(longest, within);
      continue;
    }
    const auto c = closest(body.p0, body.p1, state.x[j], state.x[j + 1]);
    const double distance = std::sqrt(c.distance2), gap = distance - reach;
    least = std::min(least, gap);
    Contact* const made = gap > look_m ? nullptr : add(gap, reach, body.friction, keep, body_stuck[index * n + j]);
    if (made == nullptr) {
      keep = Vec{};
      continue;
    }
    Contact& contact = *made;
    contact.count = 2;
    contact.node[0] = contact.first = static_cast<std::int32_t>(j);
    contact.node[1] = contact.last = static_cast<std::int32_t>(j + 1);
    contact.w[0] = 1.0 - c.t, contact.w[1] = c.t;
    contact.n = distance > 1e-12 ? (1.0 / distance) * c.between : make(0, 0, 1);
    contact.surface = body.velocity;
    if constexpr (Drum) contact.surface += cross(body.spin, contact.n);
    work.spend(price::kBody + price::kGuard);
  }
  work.spend(price::kWorldNode * static_cast<long>(n));
  due = std::min(least, std::sqrt(nearest2) - longest) + travel_m;
}

template void ContactSet::collect_body<true>(const State&, const Body&, int, double, double, double, Work&) noexcept;
template void ContactSet::collect_body<false>(const State&, const Body&, int, double, double, double, Work&) noexcept;

}  // namespace ligature::physics::rod
