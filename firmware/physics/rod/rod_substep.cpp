// One substep of a rod: contact detection, new velocities, new positions, with no more work than the tick has left.

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "firmware/physics/rod/rod.hpp"
#include "firmware/physics/rod/tuning.hpp"

namespace ligature::physics::rod {
namespace {

constexpr unsigned kTwist = 1, kContact = 2, kFriction = 4, kWorld = 8, kRoll = 16, kTurning = 32, kSet = 64,
                   kDrum = 128;

}  // namespace

// Rebuilds the list of segment pairs that may touch; leaves at least `reserve` instructions of the tick's work. If too
// many pairs are near, the list is made valid for a shorter time, and so is rebuilt sooner. @return false when there is
// not enough work even for a list with the shortest validity.
bool Rod::relist(long reserve) noexcept {
  Outlook outlook{2.0 * material_.radius_m, 2.0 * material_.radius_m * tuning.skin_d, near_m_, 0.0};
  broad_.keep_impulses(contacts_.pairs);
  stale_ = true;
  const long share = work_.budget() / 2;  // the most that a list may cost
  for (const double ticks : {1.0, 0.125, 0.0}) {
    const long most = std::min(work_.left() - reserve, share);
    if (most < BroadPhase::least_cost(state_.nodes())) break;
    horizon_s_ = outlook.horizon_s = ticks * numerics_.tick_s;
    ++report_.broad_phases;
    if (!broad_.build(state_, motion_, outlook, most, work_, {contacts_.pairs, contacts_.groups})) continue;
    stale_ = false;
    return true;
  }
  broad_.put_back({contacts_.pairs, contacts_.groups});
  return false;
}

// Contact detection: collects all contacts of this substep. @return false if too little work or time is left.
template <unsigned Bits>
bool Rod::look(double dt_s) noexcept {
  contacts_.begin();
  measured_ = false;
  seen_ = ContactReport{};
  if constexpr ((Bits & kContact) != 0) {
    const double spare_m = 2.0 * material_.radius_m * tuning.skin_d - near_m_;
    if ((stale_ || motion_.used_up(spare_m, horizon_s_, 2.0 * dt_s)) && !relist(0)) return false;
  }
  const long before = work_.used();
  if constexpr ((Bits & kContact) != 0) {
    if (!contacts_.collect_thread(state_, motion_, dt_s, material_.friction, work_, seen_)) return false;
  }
  if constexpr ((Bits & kWorld) != 0) {
    const int count = static_cast<int>(bodies.size());
    if (!ContactSet::afford_world(state_.nodes(), count, work_)) return false;
    const double look_m = near_m_ + 4.0 * motion_.fastest() * dt_s;
    if (has_floor) contacts_.collect_floor(state_, floor_m, material_.radius_m, look_m, floor_friction, work_);
    for (int b = 0; b < count; ++b) {
      if (!work_.time().allows()) return false;
      const Body& body = bodies[b];
      contacts_.collect_body<(Bits & kDrum) != 0>(state_, body, b, material_.radius_m, look_m, tick_travel_m_, work_);
    }
  }
  if constexpr ((Bits & kFriction) != 0) {
    if (sticks()) contacts_.let_stick(material_.static_friction, state_.v.data());
  }
  look_cost_ = work_.used() - before;
  since_look_s_ = 0.0;
  return measured_ = true;
}

// Work that this substep may spend on setting up its contact rows and on passes over them. For each later substep of
// the tick, the cost of the last contact detection and of the last rows with one pass are reserved. Setting up rows may
// use all that is left. Of what is not reserved, passes get twice an equal share, so that a hard substep leaves work
// for the next, and the last one may use all. Newton's method may use everything, as a substep that does not converge
// is continued in the next tick.
Rod::Allowance Rod::work_allowed(bool metric_too) const noexcept {
  const long after = report_.substeps - substep_index_ - 1;
  const auto span = contacts_.span();
  const long window = std::min(span.last - span.first + 1, metric_.capacity() - 4);
  const long metric = metric_too ? price::metric(state_.nodes(), window + 4) : 0;
  const long left = std::max(0L, work_.left() - metric - after * look_cost_);
  const long spare = std::max(0L, left - after * rows_cost_);
  const long for_passes = 2 * spare / (after + 2);
  return {window, work_.left() - metric, solves_directly() ? work_.left() - metric : for_passes};
}

bool Rod::prepare_metric(double dt_s) noexcept {
  const int n = state_.nodes(), first = contacts_.window_first(), last = contacts_.window_last();
  if (dt_s == metric_dt_ && metric_.covers(first, last)) return true;
  const int from = std::max(first - 2, 0), to = std::min(last + 2, n - 1);
  metric_dt_ = dt_s;
  work_.spend(price::metric(n, to - from + 1));
  return metric_.prepare(state_.mesh, material_, dt_s, from, to, work_.time());
}

// Chooses the contacts that are solved, and with them the range of nodes that is solved with contacts. @return nothing
// when not all can be afforded and the substep is not the tick's first: it then waits for the next tick. So contacts
// are left out only when the whole budget of a tick is too small for them.
std::optional<Effort> Rod::choose_rows(double dt_s) noexcept {
  const auto span = contacts_.span();
  const Allowance allowed = work_allowed(dt_s != metric_dt_ || !metric_.covers(span.first, span.last));
  const long most = std::min<long>(price::affordable_rows(allowed.rows, allowed.window), kMaxContacts);
  if (substep_index_ > 0 && most < static_cast<long>(contacts_.contacts().size())) return std::nullopt;
  contacts_.choose_rows(static_cast<int>(most), metric_.capacity() - 4, state_.nodes(), seen_);
  const long rows = contacts_.rows(), nodes = contacts_.window_last() - contacts_.window_first() + 1;
  const long least = price::pass(rows, rows, nodes);
  rows_cost_ = rows > 0 ? price::rows(rows, nodes) + least : 0;
  return Effort{
      work_.time(), numerics_.max_passes, std::max(least, allowed.passes - price::rows(rows, nodes)),
      tolerance({.hands = pace_m_per_s_, .own = stir_m_per_s_, .fastest = motion_.fastest()}, alone_, numerics_)};
}

// Newton's method with all the work that is left. @return kUnsolved when sweeps must solve the substep, kLater when it
// is to be continued in the next tick.
template <bool Friction>
Outcome Rod::settle_directly(const Effort& effort) noexcept {
  if (!solves_directly() || patience_.sweeps_only()) return Outcome::kUnsolved;
  const long after = report_.substeps - substep_index_ - 1;
  Effort own = effort;
  own.settled_m_per_s = std::max(effort.settled_m_per_s, numerics_.settled_m_per_s);
  own.enough_m_per_s =
      tuning.newton_near * std::max(own.settled_m_per_s, tuning.newton_near * numerics_.settled_m_per_s);
  own.fair = (effort.work - after * (look_cost_ + rows_cost_)) / (after + 1);
  const Outcome outcome = contacts_.settle_directly<Friction>(solver_, own, state_.v.data(), seen_);
  if (outcome != Outcome::kUnsolved) return outcome;
  patience_.newton_failed();
  const long nodes = contacts_.window_last() - contacts_.window_first() + 1;
  const bool can_sweep = effort.work - seen_.work >= price::pass(contacts_.rows(), contacts_.rows(), nodes);
  return can_sweep ? outcome : Outcome::kLater;
}

// Solves for the new velocities with contacts. @return false if the substep must wait for the next tick.
template <unsigned Bits>
bool Rod::settle(double dt_s) noexcept {
  constexpr bool kRubs = (Bits & kFriction) != 0, kTurns = kRubs && (Bits & kTurning) != 0;
  const auto effort = choose_rows(dt_s);
  if (!effort) return false;
  const int first = contacts_.window_first(), last = contacts_.window_last();
  if (!work_.time().allows()) return false;
  solver_.factor((first + last) / 2);
  if (!work_.time().allows()) return false;
  if (contacts_.rows() > 0) {
    if constexpr (kTurns) contacts_.turn_with(spin_, state_.nodes() - 1, material_.radius_m);
    contacts_.start<kTurns>(solver_, numerics_, dt_s, state_.v.data());
    Outcome outcome = Outcome::kUnsolved;
    if constexpr (!kTurns) {
      outcome = settle_directly<kRubs>(*effort);
      if (outcome == Outcome::kLater) {
        work_.spend(price::rows(contacts_.rows(), last - first + 1) + seen_.work);
        return put_off();
      }
    }
    if (outcome != Outcome::kSettled) {
      if (!prepare_metric(dt_s) || !contacts_.settle<kRubs, kTurns>(solver_, metric_, *effort, state_.v.data(), seen_))
        return give_up();
    }
    work_.spend(price::rows(contacts_.rows(), last - first + 1) + seen_.work);
    report_.cut_short += seen_.cut_short;
  } else {
    solver_.solve(first, last, nullptr, state_.v.data(), true);
  }
  contacts_.store();
  if (kRubs && sticks()) contacts_.note_stuck<kTurns>(state_.v.data());
  solver_.solve_outside(first, last, state_.v.data());
  return true;
}

// Leaves the substep to the next tick, where Newton's method continues with a full budget. @return always false, so
// that the caller can return it.
bool Rod::put_off() noexcept {
  state_.v = v_before_;
  patience_.put_off();
  ++report_.cut_short;
  return false;
}

// Call if the tick's time is over before the first sweep: the next tick then repeats the substep from its start.
// @return always false, so that the caller can return it.
bool Rod::give_up() noexcept {
  state_.v = v_before_;
  work_.spend(seen_.work);
  ++report_.cut_short;
  return false;
}

// The guard for pairs of segments that this substep has not measured, but which may meet after a sudden acceleration,
// such as a release. Pairs on the list limit the step by a lower bound of their distance, all other pairs by the margin
// with which the list was made. If this shortens the step and work is left, a new list is made. @return the allowed
// share of dt_s; nothing if too little work is left and the substep can wait.
std::optional<double> Rod::guard_unseen(double dt_s) noexcept {
  const double diameter = 2.0 * material_.radius_m, unseen = 0.9 * (diameter * BroadPhase::kLeastReach + near_m_);
  const double ahead_m = diameter * (tuning.skin_d + 0.9 * BroadPhase::kLeastReach);
  double share = motion_.share_within(ahead_m, horizon_s_, dt_s);
  if (share == 1.0 && !motion_.outran(unseen, dt_s)) return 1.0;
  const long listed = price::kGuardListed * static_cast<long>(contacts_.pairs.size());
  const auto without_work = [&](double known) { return can_wait() ? std::nullopt : std::optional(known); };
  if (work_.unspent() < listed) return without_work(0.0);
  work_.spend(listed);
  share = std::min(share, contacts_.safe_fraction_of_pairs(motion_, state_, dt_s));
  const long reserve = price::kGuardListed * static_cast<long>(contacts_.pairs.capacity());
  if (share == 1.0) return share;
  if (work_.left() < reserve + work_.budget() / 4) return without_work(share);
  if (!relist(reserve)) return without_work(0.0);
  work_.spend(price::kGuardListed * static_cast<long>(contacts_.pairs.size()));
  return std::min(contacts_.safe_fraction_of_pairs(motion_, state_, dt_s),
                  motion_.share_within(ahead_m, horizon_s_, dt_s));
}

// Scales all velocities down, so that velocities that did not converge cannot deepen the overlaps of a jam. Hand forces
// are computed from the velocities before scaling, because the dampers of the couplings would turn the sudden change of
// speed into a force peak.
// @return the scale factor.
double Rod::brake(double dt_s) noexcept {
  const double share = contacts_.unsettled_fraction(state_.v.data(), dt_s);
  if (share < 1.0) {
    feel_hands(dt_s);
    braked_ = true;
    for (auto& v : state_.v) v = share * v;
    motion_.measure(state_.v.data());
  }
  return share;
}

// Updates motion_ with the new velocities, and applies the brake and the guard. A substep that must wait is not braked.
// @return the share of dt_s for which everything can move without strands passing through each other; nothing if the
// substep must wait.
template <unsigned Bits>
std::optional<double> Rod::guard(double dt_s) noexcept {
  motion_.measure(state_.v.data());
  double share = 1.0;
  if constexpr ((Bits & kContact) != 0) {
    const auto unseen = guard_unseen(dt_s);
    if (!unseen) return std::nullopt;
    share = *unseen;
  }
  // Sweeps that replace an unfinished Newton solution converge slowly: their error is about 100 times the last change
  const bool far_off = seen_.change_m_per_s > loose_m_per_s() || (alone_ && patience_.sweeps_only());
  const double slow = seen_.cut_short && far_off ? brake(dt_s) : 1.0;
  share = std::min(share, contacts_.safe_fraction(motion_, state_, dt_s));
  report_.guard_events += share < 1.0;
  report_.time_lost += (1.0 - share * slow) / report_.substeps;
  return share;
}

template <unsigned Bits>
void Rod::move(double dt_s, double share) noexcept {
  double step_s = dt_s;
  if constexpr ((Bits & (kContact | kWorld)) != 0) {
    step_s *= share;
    since_look_s_ = step_s;
    motion_.advance(step_s);
    tick_travel_m_ += step_s * motion_.fastest();
    report_.contacts = static_cast<int>(contacts_.contacts().size());
    report_.passes += seen_.passes;
    report_.min_gap_m = std::min(report_.min_gap_m, seen_.min_gap_m);
    report_.rows_left_out = std::max(report_.rows_left_out, seen_.rows_left_out);
  }
  for (std::size_t i = 0; i < state_.x.size(); ++i) state_.x[i] += step_s * state_.v[i];
}

template <unsigned Bits>
bool Rod::substep(double dt_s) noexcept {
  // Templates are compiled for fewer combinations: solving contacts does not depend on plastic bending, and a drum
  // matters only while contacts are collected
  constexpr unsigned kLook = Bits & ~kSet, kRest = kLook & ~kDrum;
  constexpr bool kTouches = (Bits & (kContact | kWorld)) != 0;
  if constexpr (kTouches) {
    v_before_ = state_.v;
    if (!look<kLook>(dt_s)) return false;
  }
  if constexpr ((Bits & kSet) != 0) report_.set_J += spin_.yield(material_, state_);
  if (!work_.time().allows()) return false;
  assemble<(Bits & kTwist) != 0>(material_, state_, gravity, dt_s, forces_, solver_);
  if constexpr ((Bits & kRoll) != 0) spin_.assemble(material_, state_, dt_s);
  if (kTouches && !contacts_.contacts().empty()) {
    if (!settle<kRest>(dt_s)) return false;
  } else {
    const int first = (state_.nodes() - 2) / 2, last = first + 1;
    if (!work_.time().allows()) return false;
    solver_.factor(first);
    solver_.solve(first, last, nullptr, state_.v.data(), true);
    solver_.solve_outside(first, last, state_.v.data());
  }
  double share = 1.0;
  if constexpr (kTouches) {
    const auto safe = guard<kRest>(dt_s);
    if (!safe) return put_off();
    share = *safe;
    patience_.moved();
  }
  if constexpr ((Bits & kRoll) != 0) spin_.advance(material_, state_, forces_, dt_s);
  move<kRest>(dt_s, share);
  return true;
}

Rod::Substep Rod::pick(const Parts& parts) noexcept {
  static constexpr unsigned kWith[] = {0,
                                       kTwist,
                                       kTwist | kSet,
                                       kTwist | kRoll,
                                       kTwist | kRoll | kSet,
                                       kTwist | kRoll | kTurning,
                                       kTwist | kRoll | kTurning | kSet};
  static constexpr auto kTable = []<std::size_t... I>(std::index_sequence<I...>) {
    return std::array<Substep, sizeof...(I)>{&Rod::substep<2 * (I % 8) | kWith[I / 8]>...};
  }
  (std::make_index_sequence<8 * std::size(kWith)>{});
  static_assert(2 * 7 == (kContact | kFriction | kWorld));
  static constexpr auto kDrums = []<std::size_t... I>(std::index_sequence<I...>) {
    return std::array<Substep, sizeof...(I)>{&Rod::substep<kDrum | kContact | kFriction | kWorld | kWith[I]>...};
  }
  (std::make_index_sequence<std::size(kWith)>{});
  const std::size_t touches = (parts.contact ? 1 : 0) | (parts.friction ? 2 : 0) | (parts.world ? 4 : 0);
  const std::size_t set = parts.set ? 1 : 0;
  const std::size_t with = parts.roll ? (parts.turning ? 5 : 3) + set : parts.set ? 2 : parts.twist ? 1 : 0;
  return parts.drum && touches == 7 ? kDrums[with] : kTable[8 * with + touches];
}

}  // namespace ligature::physics::rod
