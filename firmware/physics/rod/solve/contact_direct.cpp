// Driver of Newton's method for contacts. Checks all contacts for violated conditions and takes Newton steps on the
// contacts in the system. Repeats this until all conditions hold, or the work allowed for this tick is used up.

#include <algorithm>
#include <cmath>
#include <optional>

#include "firmware/physics/rod/contact/contact_set.hpp"
#include "firmware/physics/rod/tuning.hpp"

namespace ligature::physics::rod {

// Gives the impulses p_ to the contacts in Newton's system, and updates the velocities v with the present matrix A.
void ContactSet::take_impulses(BandSolver& solver, Vec* v) noexcept {
  clear_extra();
  for (const auto k : newton_.rows()) {
    Contact& c = contacts_[k];
    const Vec p = p_[k], delta = p - c.p;
    c.p = p;
    for (int j = 0; j < c.count; ++j) extra_[c.node[j]] += c.w[j] * delta;
  }
  push(solver, v);
}

// Computes the inverse matrix Z of the present matrix A, and restarts newton_ with it. @return false if too little work
// is left.
bool ContactSet::renew_matrix(const BandSolver& solver, Search& search) noexcept {
  if (!search.pay(price::factors(window_last_ - window_first_ + 1))) return false;
  newton_.measure(solver, window_first_, window_last_);
  newton_.start(contacts_.data(), rows_);
  return search.fresh = true;
}

// Adds contacts that violate their conditions to the system, and computes their couplings. @return kSettled if this was
// done, kLater if too little work or time is left, kUnsolved if the system is full.
Outcome ContactSet::look_at_all(const BandSolver& solver, const Vec* v, Search& search) noexcept {
  const Contact* const rows = contacts_.data();
  const Vec* const p = p_.data();
  Vec* const u = u_.data();
  if (!search.pay(price::look(rows_))) return Outcome::kLater;
  for (int k = 0; k < rows_; ++k) u[k] = velocity<false>(k, v);
  if (!newton_.look(rows, rows_, p, u)) {  // full: a new matrix drops contacts that no longer carry load
    if (search.fresh || !renew_matrix(solver, search) || !newton_.look(rows, rows_, p, u)) return Outcome::kUnsolved;
  }
  const auto uncoupled = newton_.uncoupled();
  if (!search.pay(uncoupled.columns * price::column(newton_.nodes()) +
                  price::couple(uncoupled.contacts, uncoupled.pairs, newton_.nodes()) + price::read(newton_.loaded())))
    return Outcome::kLater;
  return newton_.couple(search.effort.time) ? Outcome::kSettled : Outcome::kLater;
}

// Newton steps until the residual meets the tolerance; once the fair share of the work is used, the best impulses so
// far are accepted if they meet a looser tolerance. newton_'s inverse matrix may be from an earlier substep. @return
// nothing when the result must be confirmed by computing the velocities with the present matrix A; otherwise the
// outcome.
template <bool Friction>
std::optional<Outcome> ContactSet::step_on(Search& search) noexcept {
  const Effort& effort = search.effort;
  ContactReport& report = search.report;
  const double settled = tuning.newton_near * effort.settled_m_per_s, settled2 = settled * settled;
  const double old = tuning.newton_near * tuning.newton_near * settled, old2 = old * old;
  const double enough = tuning.newton_near * effort.enough_m_per_s, enough2 = enough * enough;
  const Contact* const rows = contacts_.data();
  Vec *const p = p_.data(), *const u = u_.data();
  const auto wait = [&] { return newton_.put_off(p), Outcome::kLater; };
  double best2 = 1e300;  // smallest squared residual; its impulses are in plain_
  for (int step = 0;; ++step) {
    const double error2 = newton_.read<Friction>(rows, p, u);
    const bool begins = step == 0 && search.look == 0;
    if (step == 0) {  // u was computed with the present matrix A
      report.change_m_per_s = std::sqrt(error2);
      if (error2 < (begins ? settled2 : old2)) return Outcome::kSettled;
    }
    if (error2 < settled2) return std::nullopt;
    if (error2 < best2 && error2 < enough2) {
      best2 = error2;
      for (const auto k : newton_.rows()) plain_[k].v = p[k].v;
    }
    if (newton_.unknowns() > ContactNewton::kMostUnknowns) return Outcome::kUnsolved;
    const long cost = begins ? price::dense_sweep(newton_.loaded())
                             : price::newton(newton_.loaded(), newton_.unknowns()) +
                                   price::exchange(newton_.exchanges(), newton_.slots());
    const long answering = price::answer(newton_.loaded(), search.nodes) + price::look(rows_);
    const bool gone = !search.can_pay(cost + answering) || !effort.time.allows();
    if (gone || (best2 < enough2 && report.work + cost > effort.fair)) {
      if (step == 0) return error2 < enough2 ? Outcome::kSettled : wait();
      if (best2 >= enough2 || !search.can_pay(answering + price::read(newton_.loaded()))) return wait();
      for (const auto k : newton_.rows()) p[k].v = plain_[k].v;
      return std::nullopt;
    }
    report.work += cost;
    if (begins) {
      newton_.sweep<Friction>(rows, p, u);
    } else {
      ++report.passes;
      if (!newton_.solve<Friction>(rows, p, u, effort.time)) return effort.time.is_over() ? wait() : Outcome::kUnsolved;
    }
  }
}

template <bool Friction>
Outcome ContactSet::newton_steps(BandSolver& solver, const Effort& effort, Vec* v, ContactReport& report) noexcept {
  Search search{effort, report, window_last_ - window_first_ + 1};
  const auto answer = [&] {
    report.work += price::answer(newton_.loaded(), search.nodes);
    take_impulses(solver, v);
  };
  if (newton_.covers(window_first_, window_last_)) {
    newton_.start(contacts_.data(), rows_);
  } else if (!renew_matrix(solver, search)) {
    return Outcome::kLater;
  }
  if (newton_.resume(p_.data())) answer();
  for (;; ++search.look) {  // ends because each look costs work
    if (search.look == tuning.stale && !search.fresh && !renew_matrix(solver, search)) break;
    const Outcome looked = look_at_all(solver, v, search);
    if (looked == Outcome::kUnsolved) return looked;
    if (looked == Outcome::kLater) break;
    if (const auto end = step_on<Friction>(search)) return *end;
    answer();
  }
  newton_.put_off(p_.data());
  return Outcome::kLater;
}

template <bool Friction>
Outcome ContactSet::settle_directly(BandSolver& solver, const Effort& effort, Vec* v, ContactReport& report) noexcept {
  const long nodes = window_last_ - window_first_ + 1;
  if (nodes > ContactNewton::kWidest) return Outcome::kUnsolved;
  const long matrix = newton_.covers(window_first_, window_last_) ? 0 : price::factors(nodes);
  if (matrix + price::look(rows_) > effort.work) return Outcome::kLater;
  for (int k = 0; k < rows_; ++k) {
    const auto at = static_cast<std::size_t>(k);
    p_start_[at].v = p_[at].v = contacts_[at].p.v;
  }
  std::copy(v + window_first_, v + window_last_ + 1, v_start_.begin());
  const Outcome outcome = newton_steps<Friction>(solver, effort, v, report);
  if (outcome == Outcome::kSettled) {
    for (const auto k : newton_.rows()) {
      Contact& c = contacts_[k];
      c.p = in_cone(c.p, c.n, c.mu);
    }
    return outcome;
  }
  for (int k = 0; k < rows_; ++k) contacts_[k].p.v = p_start_[k].v;
  std::copy(v_start_.begin(), v_start_.begin() + nodes, v + window_first_);
  return outcome;
}

template Outcome ContactSet::settle_directly<true>(BandSolver&, const Effort&, Vec*, ContactReport&) noexcept;
template Outcome ContactSet::settle_directly<false>(BandSolver&, const Effort&, Vec*, ContactReport&) noexcept;

}  // namespace ligature::physics::rod
