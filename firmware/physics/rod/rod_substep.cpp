// One substep of a rod: what moves, what touches what, velocities, positions.

#include <algorithm>
#include <array>
#include <utility>

#include "firmware/physics/rod/rod.hpp"

namespace ligature::physics::rod {
namespace {

constexpr unsigned kTwist = 1, kContact = 2, kFriction = 4, kWorld = 8;
constexpr int kLeastPasses = 4;   // of any substep, however much the tick has used
constexpr double kNear = 0.1;     // diameters within which a pair is a contact at any speed
constexpr double kSkin = 0.5;     // diameters a list of pairs looks ahead at any speed
constexpr double kHorizon = 1.2;  // ticks it looks ahead at today's speeds

}  // namespace

void Rod::broad_phase() noexcept {
  Outlook outlook{2.0 * material_.radius_m, 2.0 * material_.radius_m * kSkin, kHorizon * numerics_.tick_s};
  bool room = false;
  for (int k = 0; k < 4 && !room; ++k) {  // no room: look less far ahead, more often
    room = broad_.build(state_, motion_, outlook, contacts_.pairs);
    horizon_s_ = outlook.horizon_s;
    outlook.horizon_s *= 0.25;
    ++report_.broad_phases;
  }
  stale_ = false;
  report_.cap_hit |= !room;
}

// Everything that may touch in this substep, and the window of nodes it touches.
template <unsigned Bits>
ContactReport Rod::collect(double dt_s, double near_m, double look_m) noexcept {
  ContactReport seen;
  contacts_.begin();
  if constexpr ((Bits & kContact) != 0) {
    const double spare = 2.0 * material_.radius_m * kSkin - near_m;
    if (stale_ || motion_.used_up(spare, horizon_s_, 2.0 * dt_s)) broad_phase();
    contacts_.collect_thread(state_, motion_, near_m, dt_s, material_.friction, seen);
  }
  if constexpr ((Bits & kWorld) != 0) {
    if (has_floor) contacts_.collect_floor(state_, floor_m, material_.radius_m, look_m, floor_friction, seen);
    for (std::size_t b = 0; b < bodies.size(); ++b) {
      contacts_.collect_body(state_, bodies[b], static_cast<int>(b), material_.radius_m, look_m, tick_travel_m_, seen);
    }
  }
  return seen;
}

// The share of dt_s that everything may move without passing anything. New velocities are measured here.
template <unsigned Bits>
double Rod::guard(double dt_s, double near_m) noexcept {
  motion_.measure(state_.v.data());
  double share = contacts_.safe_fraction(motion_, state_.v.data(), dt_s);
  if constexpr ((Bits & kContact) != 0) {
    const double unseen = 0.9 * (2.0 * material_.radius_m * BroadPhase::kLeastReach + near_m);
    if (motion_.outran(unseen, dt_s)) {  // a jerk, such as a release: look again, at today's speed
      broad_phase();
      share = std::min(share, contacts_.safe_fraction_of_pairs(motion_, state_.v.data(), dt_s));
    }
  }
  report_.guard_events += share < 1.0;
  return share;
}

// Up to twice a fair share of what is left of the tick's passes, so that a hard substep does not starve the next.
int Rod::passes_allowed() const noexcept {
  const int left = numerics_.passes_per_substep * numerics_.substeps - report_.passes;
  return std::clamp(2 * left / (report_.substeps - substep_index_), kLeastPasses, numerics_.max_passes);
}

// One substep: forces and matrix, what touches what, velocities, positions.
template <unsigned Bits>
void Rod::substep(double dt_s) noexcept {
  constexpr bool kTouches = (Bits & (kContact | kWorld)) != 0;
  assemble<(Bits & kTwist) != 0>(material_, state_, gravity, dt_s, forces_, solver_);
  const int n = state_.nodes();
  int first = (n - 2) / 2, last = first + 1;
  [[maybe_unused]] ContactReport seen;
  [[maybe_unused]] const double near_m = 2.0 * material_.radius_m * kNear;
  if constexpr (kTouches) {
    seen = collect<Bits>(dt_s, near_m, near_m + 4.0 * motion_.fastest() * dt_s);
    if (!contacts_.empty()) {
      first = contacts_.window_first();
      last = contacts_.window_last();
      if (first == last) (last + 1 < n ? last : first) += last + 1 < n ? 1 : -1;
    }
  }
  solver_.factor((first + last) / 2);
  bool free = true;
  if constexpr (kTouches) {
    if (!contacts_.empty()) {
      free = false;
      if (dt_s != metric_dt_ || !metric_.covers(first, last)) {
        metric_dt_ = dt_s;
        metric_.prepare(state_.mesh, material_, dt_s, std::max(first - 2, 0), std::min(last + 2, n - 1));
      }
      const int passes = passes_allowed();
      contacts_.settle<(Bits & kFriction) != 0>(solver_, metric_, numerics_, passes, settled_m_per_s_, dt_s, first,
                                                last, state_.v.data(), seen);
      report_.cut_short += seen.passes >= passes;
      contacts_.store();
    }
  }
  if (free) solver_.solve(first, last, nullptr, state_.v.data(), true);
  solver_.solve_outside(first, last, state_.v.data());
  double step_s = dt_s;
  if constexpr (kTouches) {
    step_s *= guard<Bits>(dt_s, near_m);
    motion_.advance(step_s);
    tick_travel_m_ += step_s * motion_.fastest();
    report_.contacts = static_cast<int>(contacts_.contacts().size());
    report_.passes += seen.passes;
    report_.min_gap_m = std::min(report_.min_gap_m, seen.min_gap_m);
    report_.cap_hit |= seen.cap_hit;
  }
  for (std::size_t i = 0; i < state_.x.size(); ++i) state_.x[i] += step_s * state_.v[i];
}

Rod::Substep Rod::pick(const Parts& parts) noexcept {
  static constexpr auto kTable = []<std::size_t... I>(std::index_sequence<I...>) {
    return std::array<Substep, sizeof...(I)>{&Rod::substep<I>...};
  }
  (std::make_index_sequence<16>{});
  return kTable[(parts.twist ? kTwist : 0) | (parts.contact ? kContact : 0) | (parts.friction ? kFriction : 0) |
                (parts.world ? kWorld : 0)];
}

}  // namespace ligature::physics::rod
