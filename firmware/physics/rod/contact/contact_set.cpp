#include "firmware/physics/rod/contact/contact_set.hpp"
#include "firmware/physics/rod/tuning.hpp"

#include <algorithm>
#include <cassert>

namespace ligature::physics::rod {

void ContactSet::reserve(int nodes, int bodies, int window) {
  const auto n = static_cast<std::size_t>(nodes);
  const auto rows = static_cast<std::size_t>(kMaxContacts);
  contacts_.reserve(rows + 3 * n);
  gaps_.reserve(contacts_.capacity());
  pairs.reserve(24 * n + 1024);
  watched_.reserve(pairs.capacity());
  for (auto* array : {&awake_, &due_}) array->reserve(pairs.capacity());
  for (auto* array : {&close_, &far_}) array->reserve(pairs.capacity() + 4);
  measured_.resize(pairs.capacity());
  near_.reserve(pairs.capacity());
  heads_.reserve(kBinsPerNode * n);
  corner_.assign(n, Vec{});
  share_.assign(n, 0.0);
  groups.reserve(pairs.capacity());
  floor_impulse.assign(n, Vec{});
  body_impulse.assign(n * static_cast<std::size_t>(bodies), Vec{});
  floor_stuck.assign(floor_impulse.size(), 0);
  body_stuck.assign(body_impulse.size(), 0);
  body_due_.assign(static_cast<std::size_t>(bodies), -1.0);
  columns_.resize(rows * (static_cast<std::size_t>(window) + 8));
  swept_.reserve(window);
  for (auto* array : {&extra_, &step_}) array->assign(n, Vec{});
  for (auto* array : {&p_, &plain_, &residual_}) array->assign(rows, Vec{});
  loaded_.reserve(rows);
  mixing_.reserve(rows);
  newton_.reserve();
  for (auto* array : {&u_, &p_start_}) array->assign(rows, Vec{});
  v_start_.assign(static_cast<std::size_t>(ContactNewton::kWidest), Vec{});
}

void ContactSet::let_stick(double mu_static, const Vec* v) noexcept {
  for (auto& c : contacts_) {
    bool holds = *c.stuck != 0;
    if (dot(c.p, c.p) == 0.0) {
      Vec u = velocity(c, v);
      u -= dot(u, c.n) * c.n;
      holds = dot(u, u) < tuning.settled_m_per_s * tuning.settled_m_per_s;
    }
    if (holds) c.mu = mu_static;
  }
}

ContactSet& ContactSet::operator=(const ContactSet& other) {
  ContactMemory::operator=(other);
  forget_matrix();
  return *this;
}

// The objective that frictionless impulses minimise. It is the sum over all rows of
//   1/2 p . (u + u_free) - target p_n + 1/2 soft p_n^2
// p: impulse, p_n: its normal part, u: relative velocity, u_free: relative velocity without impulses, target: wanted
// normal velocity, soft: the contact's compliance.
template <bool Turns>
double ContactSet::merit(const Vec* v) const noexcept {
  double sum = 0.0;
  for (const auto k : loaded_) {
    const Contact& c = contacts_[k];
    const double pn = dot(c.p, c.n);
    sum += 0.5 * dot(c.p, velocity<Turns>(k, v) + c.u_free) - pn * c.target + 0.5 * c.soft * pn * pn;
  }
  return sum;
}

void ContactSet::clear_extra() noexcept {
  std::fill(extra_.begin() + window_first_, extra_.begin() + window_last_ + 1, Vec{});
}

double ContactSet::push(BandSolver& solver, Vec* v) noexcept {
  solver.solve(window_first_, window_last_, extra_.data(), step_.data(), false);
  Lanes largest2{};
  for (int i = window_first_; i <= window_last_; ++i) {
    const Lanes step = step_[i].v, step2 = step * step;
    v[i].v += step;
    largest2 = step2 > largest2 ? step2 : largest2;
  }
  return largest2[0] + largest2[1] + largest2[2];
}

// Computes a row's column B = C^-1 J^T (velocities of the nodes per unit impulse), eight nodes at a time, and J B, the
// row's own velocity per unit impulse.
void ContactSet::make_column(Contact& c, const ContactMetric& metric, float* column) const noexcept {
  const auto offset = static_cast<std::size_t>(window_first_ - metric.first());
  const float* r[Contact::kMostNodes];
  Eight w[Contact::kMostNodes];
  for (int k = 0; k < c.count; ++k) {
    r[k] = metric.row(c.node[k]) + offset;
    c.weight[k] = static_cast<float>(c.w[k]);
    c.place[k] = SweptVelocities::place(c.node[k] - window_first_);
    w[k] = all_eight(c.weight[k]);
  }
  for (std::size_t j = 0; j < stride_; j += 8) {
    Eight sum =
        w[0] * load_as<Eight>(r[0] + j);  // NOLINT(clang-analyzer-core.UndefinedBinaryOperatorResult): c.count >= 1
    for (int k = 1; k < c.count; ++k) sum += w[k] * load_as<Eight>(r[k] + j);
    store_as(column + j, sum);
  }
  double own = 0.0;
  for (int k = 0; k < c.count; ++k) own += c.w[k] * static_cast<double>(column[c.node[k] - window_first_]);
  c.inv_w = 1.0 / own;
  c.inv_soft_w = 1.0 / (own + c.soft);
}

bool ContactSet::make_columns(const ContactMetric& metric, TickTime& time) noexcept {
  stride_ = SweptVelocities::padded(window_last_ - window_first_ + 1);
  float* column = columns_.data();
  Pieces pieces(time);
  for (int k = 0; k < rows_; ++k, column += stride_) {
    if (!pieces.allow(100 + static_cast<long>(stride_))) return false;
    make_column(contacts_[k], metric, column);
  }
  return time.allows();
}

template <bool Friction, bool Turns>
void ContactSet::sweep(const Vec* v, TickTime& time) noexcept {
  Pieces pieces(time);
  swept_.load(v + window_first_, window_last_ - window_first_ + 1);
  const float* column = columns_.data();
  for (int index = 0; index < rows_ && pieces.allow(price::row_of_pass(static_cast<long>(stride_)));
       ++index, column += stride_) {  // a sweep cut off by the clock is still a valid sweep of fewer rows
    Contact& c = contacts_[index];
    Vec u = swept_.mix(c.place, c.weight, c.count) - c.surface;
    if constexpr (Turns) u += turning_.slip(index);
    const double un = dot(u, c.n), pn_before = dot(c.p, c.n);
    const double pn = pn_before - c.inv_soft_w * (un + c.soft * pn_before - c.target);
    Vec p{};
    if (pn > 0.0) {
      if constexpr (Friction) {
        const Vec pt = (c.p - pn_before * c.n) - c.inv_w * (u - un * c.n);
        p = pn * c.n + limited(pt, c.mu * pn);
      } else {
        p = pn * c.n;
      }
    } else if (dot(c.p, c.p) == 0.0) {
      continue;
    }
    if (!c.loaded) c.loaded = true, loaded_.push_back(index), residual_[loaded_.size() - 1] = Vec{};
    const Vec delta = p - c.p;
    c.p = p;
    for (int j = 0; j < c.count; ++j) extra_[c.node[j]] += c.w[j] * delta;
    swept_.push(column, stride_, delta);
    if constexpr (Turns) turning_.push(index, delta);
  }
}

// Computes the target normal velocities, the starting impulses (those of the last substep, limited to the new friction
// cones), and the velocities without and with the starting impulses.
template <bool Turns>
void ContactSet::start(BandSolver& solver, const Numerics& numerics, double dt_s, Vec* v) noexcept {
  const double longer = per_second_ > 0.0 ? dt_s * per_second_ : 1.0;  // ratio of time steps, to keep the same forces
  per_second_ = 1.0 / dt_s;
  solver.solve(window_first_, window_last_, nullptr, v, true);
  clear_extra();
  loaded_.clear();
  for (int k = 0; k < rows_; ++k) {
    Contact& c = contacts_[k];
    c.soft = numerics.recovery / (numerics.contact_N_per_m * dt_s * dt_s);
    c.target = -(c.gap_m > 0.0 ? 1.0 : numerics.recovery) * c.gap_m / dt_s;
    c.p = in_cone(longer * c.p, c.n, c.mu);
    c.u_free = velocity<Turns>(k, v);
    c.loaded = dot(c.p, c.p) > 0.0;
    if (!c.loaded) continue;
    loaded_.push_back(k);
    for (int j = 0; j < c.count; ++j) extra_[c.node[j]] += c.w[j] * c.p;
  }
  if constexpr (Turns) {
    for (const auto k : loaded_) turning_.push(k, contacts_[k].p);
  }
  push(solver, v);
}

template <bool Friction, bool Turns>
double ContactSet::plain_pass(BandSolver& solver, Vec* v, TickTime& time) noexcept {
  clear_extra();
  for (std::size_t k = 0; k < loaded_.size(); ++k) residual_[k].v = loaded(k).p.v;
  sweep<Friction, Turns>(v, time);
  for (std::size_t k = 0; k < loaded_.size(); ++k) {
    plain_[k].v = p_[k].v = loaded(k).p.v;
    residual_[k] = p_[k] - residual_[k];
  }
  return push(solver, v);
}

// Anderson mixing. The mixed impulses, limited to their friction cones, are kept only if their merit() is not larger
// than that of the impulses of the plain pass.
template <bool Turns>
void ContactSet::mix(BandSolver& solver, Vec* v) noexcept {
  if (!mixing_.step(p_.data(), residual_.data(), loaded_.size())) return;
  const double plain_merit = merit<Turns>(v);
  clear_extra();
  if constexpr (Turns) turning_.save();
  for (std::size_t k = 0; k < loaded_.size(); ++k) {
    Contact& c = loaded(k);
    c.p = in_cone(p_[k], c.n, c.mu);
    const Vec delta = c.p - plain_[k];
    for (int j = 0; j < c.count; ++j) extra_[c.node[j]] += c.w[j] * delta;
    if constexpr (Turns) turning_.push(loaded_[k], delta);
  }
  push(solver, v);
  if (merit<Turns>(v) <= plain_merit) return;
  for (int i = window_first_; i <= window_last_; ++i) v[i] -= step_[i];
  for (std::size_t k = 0; k < loaded_.size(); ++k) loaded(k).p.v = plain_[k].v;
  if constexpr (Turns) turning_.restore();
  mixing_.restart();
}

template <bool Friction, bool Turns>
bool ContactSet::settle(BandSolver& solver, const ContactMetric& metric, const Effort& effort, Vec* v,
                        ContactReport& report) noexcept {
  if (!make_columns(metric, effort.time)) return false;
  newton_.give_up();
  if constexpr (Turns) turning_.shorten_steps(contacts_.data());
  mixing_.restart();
  const long nodes = window_last_ - window_first_ + 1;
  const double settled2 = effort.settled_m_per_s * effort.settled_m_per_s;
  const long turning = Turns ? turning_.price(rows_) : 0;
  for (;;) {
    const double largest2 = plain_pass<Friction, Turns>(solver, v, effort.time);
    ++report.passes;
    report.work += price::pass(rows_, static_cast<long>(loaded_.size()), nodes) + turning;
    if (largest2 < settled2 && !effort.time.is_over()) return true;
    // In the worst case every row carries an impulse in the next pass.
    report.change_m_per_s = std::sqrt(largest2);
    report.cut_short = report.passes >= effort.passes ||
                       report.work + price::pass(rows_, rows_, nodes) + turning > effort.work || !effort.time.allows();
    if (report.cut_short) return true;
    mix<Turns>(solver, v);
  }
}

double ContactSet::unsettled_fraction(const Vec* v, double dt_s) const noexcept {
  double share = 1.0;
  for (int k = 0; k < rows_; ++k) {
    const Contact& c = contacts_[k];
    const double closing_m = -dt_s * dot(velocity<false>(k, v), c.n);
    const double room_m = std::max(c.gap_m, loose_m_per_s() * dt_s);
    if (closing_m > room_m) share = std::min(share, room_m / closing_m);
  }
  return share;
}

double ContactSet::give_J(double k_N_per_m, const Vec* v, double step_s) const noexcept {
  double sum = 0.0;
  for (const auto& c : contacts_) {
    const double overlap_m = std::max(0.0, -c.gap_m - step_s * dot(velocity(c, v), c.n));
    sum += 0.5 * k_N_per_m * overlap_m * overlap_m;
  }
  return sum;
}

void ContactSet::store() noexcept {
  for (const auto& c : contacts_) {
    *c.keep = c.p;
    if (c.pair) c.pair->touch = c.pair->next;
  }
}

// A contact slides if it slips and its impulse is on the surface of the friction cone; without slip it sticks, even on
// that surface.
template <bool Turns>
void ContactSet::note_stuck(const Vec* v) noexcept {
  constexpr double kInside = 1.0 - 1e-9;
  for (int k = 0; k < static_cast<int>(contacts_.size()); ++k) {
    const Contact& c = contacts_[k];
    const double pn = dot(c.p, c.n), most = kInside * c.mu * pn;
    *c.stuck = 0;
    if (pn <= 0.0 || k >= rows_) continue;
    const Vec u = velocity<Turns>(k, v), along = u - dot(u, c.n) * c.n;
    const bool within_cone = dot(c.p, c.p) - pn * pn < most * most;
    *c.stuck = within_cone || dot(along, along) < tuning.settled_m_per_s * tuning.settled_m_per_s ? 1 : 0;
  }
}

void ContactSet::relabel(const std::vector<double>& s) noexcept {
  const auto segment = [&](double at) {
    const auto next = std::upper_bound(s.begin() + 1, s.end() - 1, at);
    return static_cast<std::int32_t>(next - s.begin()) - 1;
  };
  for (auto& pair : pairs) {
    if (dot(pair.impulse, pair.impulse) == 0.0) continue;
    pair.a = segment(pair.touch.a);
    pair.b = segment(pair.touch.b);
  }
}

template void ContactSet::start<true>(BandSolver&, const Numerics&, double, Vec*) noexcept;
template void ContactSet::start<false>(BandSolver&, const Numerics&, double, Vec*) noexcept;
template bool ContactSet::settle<true, true>(BandSolver&, const ContactMetric&, const Effort&, Vec*,
                                             ContactReport&) noexcept;
template bool ContactSet::settle<true, false>(BandSolver&, const ContactMetric&, const Effort&, Vec*,
                                              ContactReport&) noexcept;
template bool ContactSet::settle<false, false>(BandSolver&, const ContactMetric&, const Effort&, Vec*,
                                               ContactReport&) noexcept;
template void ContactSet::note_stuck<true>(const Vec*) noexcept;
template void ContactSet::note_stuck<false>(const Vec*) noexcept;

}  // namespace ligature::physics::rod
