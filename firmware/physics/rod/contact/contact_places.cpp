// Chooses the measured pairs of segments that become contacts: all near pairs, but of several at one place only the
// nearest.

#include <algorithm>
#include <cmath>
#include <utility>

#include "firmware/physics/rod/contact/contact_set.hpp"
#include "firmware/physics/rod/tuning.hpp"

namespace ligature::physics::rod {

// Collects the pairs whose gap is below near_m + 2 dt x the relative speed of their points. This test is stricter than
// that of find_due(), which uses an upper bound of the speed. @return false when the time was over first.
bool ContactSet::find_near(const State& state, double dt_s, Pieces& pieces) noexcept {
  near_.clear();
  const auto& mesh = state.mesh;
  double reach_m = 0.0;
  for (std::size_t k = 0; k < due_.size(); ++k) {
    if (!pieces.allow(price::kPlace)) return false;
    const Measured& m = measured_[k];
    const Candidate& pair = pairs[due_[k]];
    const auto a = static_cast<std::size_t>(pair.a), b = static_cast<std::size_t>(pair.b);
    const double gap = m.distance_m - pair.reach_m, spare = gap - pair.near_m, s = m.s, t = m.t;
    const Vec u = (1.0 - t) * state.v[b] + t * state.v[b + 1] - (1.0 - s) * state.v[a] - s * state.v[a + 1];
    if (spare > 0.0 && spare * spare > 4.0 * dt_s * dt_s * dot(u, u)) continue;
    reach_m = std::max(reach_m, pair.reach_m);
    const bool loaded = dot(pair.impulse, pair.impulse) > 0.0;
    const double ahead_m = m.distance_m > 1e-12 ? dt_s * dot(u, m.between) / m.distance_m : 0.0;
    near_.push_back({static_cast<std::int32_t>(k), -1,
                     gap + ahead_m - (loaded ? tuning.place_stays_d * pair.reach_m : 0.0), mesh.s[a] + s * mesh.rest[a],
                     mesh.s[b] + t * mesh.rest[b], loaded});
  }
  if (near_.empty()) return true;
  // Bins are at least as wide as places, so that the points at one place lie in three neighbouring bins
  const double length_m = mesh.s.back(), most = static_cast<double>(kBinsPerNode * state.x.size());
  const double bins = std::min(std::max(1.0, std::floor(length_m / (tuning.place_d * reach_m))), most);
  heads_.assign(static_cast<std::size_t>(bins), -1);  // never allocates: reserved for `most` bins
  bins_per_m_ = bins / length_m;
  return true;
}

std::size_t ContactSet::bin(double at_m) const noexcept {
  const double last = static_cast<double>(heads_.size() - 1);
  return static_cast<std::size_t>(std::min(std::max(0.0, at_m * bins_per_m_), last));  // 0 if at_m is NaN
}

// Is there already a contact at the place of the pair `one`? At one place means: on both strands, the points of the two
// pairs are less than place_d apart. Adds to `compared` the number of contacts that were looked at.
bool ContactSet::has_contact_at(const Near& one, double reach_m, long& compared) const noexcept {
  const double within_m = tuning.place_d * reach_m;
  for (std::size_t at = bin(one.a - within_m), last = bin(one.a + within_m); at <= last; ++at) {
    for (std::int32_t k = heads_[at]; k >= 0; k = near_[k].next) {
      const Near& other = near_[k];
      ++compared;
      if (std::abs(other.a - one.a) < within_m && std::abs(other.b - one.b) < within_m) return true;
    }
  }
  return false;
}

// Marks the pairs that become contacts. Where two strands come nearest at a node of each, up to four pairs of segments
// have their closest points there. If all four were contacts, Newton's method would solve four equations for one force.
// So a pair without an impulse is left out if another pair at its place will have a smaller gap at the end of the
// substep (at the present velocities). A pair with an impulse always stays a contact: where strands hook over each
// other at a corner, contacts at one place push in different directions, and each is needed. @return false if work or
// time were used up first.
bool ContactSet::choose_near(Work& work, Pieces& pieces) noexcept {
  // A heap yields one pair after the other, the nearest first, so that the work can be interrupted; a sort could not.
  const auto is_farther = [](const Near& p, const Near& q) {
    return p.gap_m > q.gap_m || (p.gap_m == q.gap_m && p.due > q.due);
  };
  std::make_heap(near_.begin(), near_.end(), is_farther);
  for (std::size_t left = near_.size(); left > 0; --left) {
    if (!pieces.allow(price::kPlace)) return false;
    std::pop_heap(near_.begin(), near_.begin() + static_cast<std::ptrdiff_t>(left), is_farther);
    Near& one = near_[left - 1];
    const auto due = static_cast<std::size_t>(one.due);
    const double reach_m = pairs[due_[due]].reach_m;
    long compared = 0;
    const bool has_contact = !one.loaded && has_contact_at(one, reach_m, compared);
    if (price::kBeside * compared > work.left() || !pieces.allow(price::kBeside * compared)) return false;
    work.spend(price::kBeside * compared);
    if (has_contact) continue;
    measured_[due].touches = true;
    one.next = std::exchange(heads_[bin(one.a)], static_cast<std::int32_t>(left - 1));
  }
  return true;
}

}  // namespace ligature::physics::rod
