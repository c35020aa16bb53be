// Which measured pairs of segments become contacts: those that are near, and of several at the same place only one.

#include <algorithm>
#include <cmath>
#include <utility>

#include "firmware/physics/rod/contact/contact_set.hpp"
#include "firmware/physics/rod/tuning.hpp"

namespace ligature::physics::rod {

// Collects the pairs whose gap is below near_m + 2 dt x the relative speed of their points. This test is stricter than
// that of find_due(), which has only a bound of the speed.
void ContactSet::find_near(const State& state, double dt_s) noexcept {
  near_.clear();
  const auto& mesh = state.mesh;
  for (std::size_t k = 0; k < due_.size(); ++k) {
    const Measured& m = measured_[k];
    const Candidate& pair = pairs[static_cast<std::size_t>(due_[k])];
    const auto a = static_cast<std::size_t>(pair.a), b = static_cast<std::size_t>(pair.b);
    const double gap = m.distance_m - pair.reach_m, spare = gap - pair.near_m, s = m.s, t = m.t;
    const Vec u = (1.0 - t) * state.v[b] + t * state.v[b + 1] - (1.0 - s) * state.v[a] - s * state.v[a + 1];
    if (spare > 0.0 && spare * spare > 4.0 * dt_s * dt_s * dot(u, u)) continue;
    const double stays = dot(pair.impulse, pair.impulse) > 0.0 ? tuning.merge_stays_d * pair.reach_m : 0.0;
    const double ahead_m = m.distance_m > 1e-12 ? dt_s * dot(u, m.between) / m.distance_m : 0.0;
    near_.push_back({static_cast<std::int32_t>(k), -1, gap + ahead_m - stays, mesh.s[a] + s * mesh.rest[a],
                     mesh.s[b] + t * mesh.rest[b]});
  }
  heads_.assign(state.x.size() + 1, -1);
}

// Where the curves of two strands come nearest at a joint of their segments, up to four pairs of segments have their
// closest points there. They are one contact, which Newton's method would otherwise solve four times: that with the
// smallest gap at the end of the substep, if velocities stay as they are. It gets the impulses of the others. @return
// false when the time was over first.
bool ContactSet::merge(TickTime& time) noexcept {
  Pieces pieces(time);
  std::sort(near_.begin(), near_.end(),
            [](const Near& p, const Near& q) { return p.gap_m < q.gap_m || (p.gap_m == q.gap_m && p.due < q.due); });
  const auto same_as = [&](const Near& one, const Candidate& pair) -> const Near* {
    const double within_m = tuning.merge_d * pair.reach_m;
    for (std::int32_t a = std::max(pair.a - 1, 0); a <= pair.a + 1; ++a) {
      for (std::int32_t k = heads_[static_cast<std::size_t>(a)]; k >= 0;) {
        const Near& other = near_[static_cast<std::size_t>(k)];
        if (std::abs(other.a - one.a) < within_m && std::abs(other.b - one.b) < within_m) return &other;
        k = other.next;
      }
    }
    return nullptr;
  };
  for (std::size_t k = 0; k < near_.size(); ++k) {
    if (!pieces.allow(price::kMerge)) return false;
    Near& one = near_[k];
    Candidate& pair = due(one.due);
    const Near* const same = same_as(one, pair);
    if (same == nullptr) {
      measured_[static_cast<std::size_t>(one.due)].touches = true;
      std::int32_t& head = heads_[static_cast<std::size_t>(pair.a)];
      one.next = std::exchange(head, static_cast<std::int32_t>(k));
    } else if (dot(pair.impulse, pair.impulse) > 0.0) {
      Candidate& stays = due(same->due);
      if (dot(stays.impulse, stays.impulse) == 0.0) stays.touch = pair.touch, stays.stuck = pair.stuck;
      stays.impulse += pair.impulse;
      pair.impulse = Vec{};
    }
  }
  return true;
}

}  // namespace ligature::physics::rod
