// Contacts solved directly: looks at what approaches, steps of Newton's method in between, within the tick's work.

#include <algorithm>

#include "firmware/physics/rod/contact.hpp"

namespace ligature::physics::rod {
namespace {

constexpr int kMargin = 6;      // nodes by which the window may grow before a new matrix is needed
constexpr double kNear = 3.0;   // an error is at most that, a pass's last change at least
constexpr double kLoose = 3.0;  // times what is settled: may be left over beyond a fair share of the work

double square_of_enough(const Effort& effort) noexcept {
  const double enough = kNear * std::max(kLoose * effort.settled_m_per_s, effort.enough_m_per_s);
  return enough * enough;
}

}  // namespace

// Impulses of p_ instead of today's, in the rows that newton_ knows; v answers.
void ContactSet::take_impulses(BandSolver& solver, Vec* v) noexcept {
  clear_extra();
  for (const auto k : newton_.rows()) {
    Contact& c = contacts_[static_cast<std::size_t>(k)];
    const Vec p = p_[static_cast<std::size_t>(k)], delta = p - c.p;
    c.p = p;
    for (int j = 0; j < c.count; ++j) extra_[static_cast<std::size_t>(c.node[j])] += c.w[j] * delta;
  }
  push(solver, v);
}

template <bool Friction>
Outcome ContactSet::newton_steps(BandSolver& solver, const Effort& effort, Vec* v, ContactReport& report) noexcept {
  constexpr int kMostLooks = 12, kMostSteps = 48, kStale = 3, kSweeps = 2;
  constexpr double kOld = 10.0;  // what an old matrix may leave over
  constexpr double kUnknown = 1e300;
  const long nodes = window_last_ - window_first_ + 1, looking = price::look(rows_);
  const double settled = kNear * effort.settled_m_per_s, settled2 = settled * settled;
  const double enough2 = square_of_enough(effort);
  const Contact* const rows = contacts_.data();
  Vec *const p = p_.data(), *const u = u_.data();
  bool fresh = false;
  const auto measure = [&] {
    const int first = std::max(window_first_ - kMargin, 0), last = std::min(window_last_ + kMargin, solver.nodes() - 1);
    report.work += price::factors(last - first + 1);
    newton_.measure(solver, first, last);
    fresh = true;
  };
  if (!newton_.covers(window_first_, window_last_)) measure();
  newton_.start(rows, rows_);
  const auto answer = [&] {
    report.work += price::answer(newton_.loaded(), nodes);
    take_impulses(solver, v);
  };
  // The work is gone: what is near enough is moved, the rest waits.
  const auto stop = [&](double error2) {
    if (error2 < enough2) return Outcome::kSettled;
    newton_.put_off(p);
    return Outcome::kLater;
  };
  double last2 = kUnknown;  // error of today's impulses, with the true A
  start_error2_ = kUnknown;
  const bool resumed = newton_.resume(p);
  if (resumed) answer();
  for (int look = 0; look < kMostLooks; ++look) {
    if (look == kStale && !fresh) {
      if (report.work + price::factors(nodes + 2 * kMargin) > effort.work) break;
      measure();
      newton_.start(rows, rows_);
    }
    if (report.work + looking > effort.work) break;
    report.work += looking;
    for (int k = 0; k < rows_; ++k) u[k] = velocity<false>(k, v);
    if (!newton_.look(rows, rows_, p, u)) {  // full of what has gone?
      if (fresh || report.work + price::factors(nodes + 2 * kMargin) > effort.work) return Outcome::kNoRoom;
      measure();
      newton_.start(rows, rows_);
      if (!newton_.look(rows, rows_, p, u)) return Outcome::kNoRoom;
    }
    const auto uncoupled = newton_.uncoupled();
    const long coupling = uncoupled.columns * price::column(newton_.nodes()) +
                          price::couple(uncoupled.contacts, uncoupled.pairs, newton_.nodes()) +
                          price::read(newton_.loaded());
    if (report.work + coupling > effort.work) break;
    report.work += coupling;
    newton_.couple();
    double best2 = kUnknown;  // error of the steps of this look; those impulses are in plain_
    for (int step = 0;; ++step) {
      const double largest2 = newton_.read<Friction>(rows, p, u);
      if (step == 0) {
        last2 = largest2;
        if (look == 0 && !resumed) start_error2_ = largest2;
        report.change_m_per_s = std::sqrt(largest2);
        if (largest2 < (look > 0 ? kOld * kOld : 1.0) * settled2) return Outcome::kSettled;
      }
      if (largest2 < settled2) break;
      if (largest2 < best2 && largest2 < enough2) {
        best2 = largest2;
        for (const auto k : newton_.rows()) plain_[static_cast<std::size_t>(k)].v = p[k].v;
      }
      if (newton_.unknowns() > ContactNewton::kMostUnknowns) return Outcome::kNoRoom;
      const long cost = look == 0 && step == 0 ? kSweeps * price::dense_sweep(newton_.loaded())
                                               : price::newton(newton_.loaded(), newton_.unknowns()) +
                                                     price::exchange(newton_.exchanges(), newton_.slots());
      const bool gone = report.work + cost + price::answer(newton_.loaded(), nodes) + looking > effort.work;
      if (gone || (best2 < enough2 && report.work + cost > effort.fair)) {
        if (step == 0) return stop(largest2);
        const long checking = price::answer(newton_.loaded(), nodes) + looking + price::read(newton_.loaded());
        if (best2 >= enough2 || report.work + checking > effort.work) return stop(kUnknown);
        for (const auto k : newton_.rows()) p[k].v = plain_[static_cast<std::size_t>(k)].v;
        break;  // enough, if the true A says so too
      }
      report.work += cost;
      if (look == 0 && step == 0) {
        for (int k = 0; k < kSweeps; ++k) newton_.sweep<Friction>(rows, p, u);
        continue;
      }
      if (++report.passes > kMostSteps) return Outcome::kNoRoom;
      if (!newton_.solve<Friction>(rows, p, u)) return Outcome::kNoRoom;
    }
    answer();
    last2 = kUnknown;
  }
  return stop(last2);
}

template <bool Friction>
Outcome ContactSet::settle_directly(BandSolver& solver, const Effort& effort, Vec* v, ContactReport& report) noexcept {
  const long nodes = window_last_ - window_first_ + 1;
  if (nodes + 2 * kMargin > ContactNewton::kWidest) return Outcome::kNoRoom;
  const long matrix = newton_.covers(window_first_, window_last_) ? 0 : price::factors(nodes + 2 * kMargin);
  if (matrix + price::look(rows_) > effort.work) return Outcome::kLater;
  for (int k = 0; k < rows_; ++k) {
    const auto at = static_cast<std::size_t>(k);
    p_start_[at].v = p_[at].v = contacts_[at].p.v;
  }
  std::copy(v + window_first_, v + window_last_ + 1, v_start_.begin());
  const Outcome outcome = newton_steps<Friction>(solver, effort, v, report);
  if (outcome == Outcome::kSettled) {
    for (const auto k : newton_.rows()) {
      Contact& c = contacts_[static_cast<std::size_t>(k)];
      c.p = in_cone(c.p, c.n, c.mu);
    }
    return outcome;
  }
  for (int k = 0; k < rows_; ++k) contacts_[static_cast<std::size_t>(k)].p.v = p_start_[static_cast<std::size_t>(k)].v;
  std::copy(v_start_.begin(), v_start_.begin() + nodes, v + window_first_);
  if (start_error2_ >= square_of_enough(effort)) return outcome;
  newton_.give_up();  // what they began with is good, and they found no better
  report.change_m_per_s = std::sqrt(start_error2_);
  return Outcome::kSettled;
}

template Outcome ContactSet::settle_directly<true>(BandSolver&, const Effort&, Vec*, ContactReport&) noexcept;
template Outcome ContactSet::settle_directly<false>(BandSolver&, const Effort&, Vec*, ContactReport&) noexcept;

}  // namespace ligature::physics::rod
