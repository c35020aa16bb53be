#include "firmware/physics/rod/contact.hpp"

#include <algorithm>
#include <cassert>

namespace ligature::physics::rod {

void ContactSet::reserve(int nodes, int bodies, int window) {
  const auto n = static_cast<std::size_t>(nodes);
  contacts_.reserve(static_cast<std::size_t>(kMaxContacts));
  pairs.reserve(24 * n + 1024);
  watched_.reserve(pairs.capacity());
  floor_impulse.assign(n, Vec{});
  body_impulse.assign(n * static_cast<std::size_t>(bodies), Vec{});
  body_due_.assign(static_cast<std::size_t>(bodies), -1.0);
  columns_.assign(static_cast<std::size_t>(kMaxContacts) * static_cast<std::size_t>(window + 4), 0.0);
  for (auto* array : {&moved_, &extra_, &step_}) array->assign(n, Vec{});
  for (auto* array : {&p_, &plain_, &residual_}) array->assign(static_cast<std::size_t>(kMaxContacts), Vec{});
  mixing_.reserve(static_cast<std::size_t>(kMaxContacts));
}

namespace {

Vec in_cone(Vec p, Vec n, double mu) noexcept {
  const double pn = dot(p, n);
  if (pn <= 0.0) return Vec{};
  const Vec pt = p - pn * n;
  const double size2 = dot(pt, pt), most = mu * pn;
  return pn * n + (size2 > most * most ? most / std::sqrt(size2) : 1.0) * pt;
}

Vec velocity(const Contact& c, const Vec* v) noexcept {
  Vec u = -c.surface;
  for (int j = 0; j < c.count; ++j) u += c.w[j] * v[c.node[j]];
  return u;
}

}  // namespace

// sum of 1/2 p . (u + u_free) - target p_n + 1/2 soft p_n^2: what the impulses of the frictionless problem minimise.
double ContactSet::merit(const Vec* v) const noexcept {
  double sum = 0.0;
  for (const auto& c : contacts_) {
    const double pn = dot(c.p, c.n);
    sum += 0.5 * dot(c.p, velocity(c, v) + c.u_free) - pn * c.target + 0.5 * c.soft * pn * pn;
  }
  return sum;
}

void ContactSet::push(double share) noexcept {
  for (const auto& c : contacts_) {
    for (int k = 0; k < c.count; ++k) extra_[static_cast<std::size_t>(c.node[k])] += (share * c.w[k]) * c.p;
  }
}

double ContactSet::add(int first, int last, Vec* v) const noexcept {
  Lanes largest2{};
  for (int i = first; i <= last; ++i) {
    const Lanes step = step_[static_cast<std::size_t>(i)].v, step2 = step * step;
    v[i].v += step;
    largest2 = step2 > largest2 ? step2 : largest2;
  }
  return largest2[0] + largest2[1] + largest2[2];
}

ContactSet& ContactSet::operator=(const ContactSet& other) {
  if (this == &other) return *this;
  begin();
  pairs.reserve(other.pairs.capacity());
  pairs = other.pairs;
  floor_impulse = other.floor_impulse;
  body_impulse = other.body_impulse;
  per_second_ = other.per_second_;
  return *this;
}

// Columns B = C^-1 J^T, the contact's own number J B, the wanted normal velocity, and the old impulse turned to today's
// normal and cone.
void ContactSet::prepare(const ContactMetric& metric, int first, int last, const Numerics& numerics,
                         double dt_s) noexcept {
  const auto nodes = static_cast<std::size_t>(last - first + 1),
             offset = static_cast<std::size_t>(first - metric.first());
  stride_ = nodes;
  per_second_ = 1.0 / dt_s;
  double* column = columns_.data();
  for (auto& c : contacts_) {
    const double* r0 = metric.row(c.node[0]) + offset;
    if (c.count == 4) {
      const double *r1 = metric.row(c.node[1]) + offset, *r2 = metric.row(c.node[2]) + offset,
                   *r3 = metric.row(c.node[3]) + offset;
      for (std::size_t j = 0; j < nodes; ++j)
        column[j] = c.w[0] * r0[j] + c.w[1] * r1[j] + c.w[2] * r2[j] + c.w[3] * r3[j];
    } else if (c.count == 2) {
      const double* r1 = metric.row(c.node[1]) + offset;
      for (std::size_t j = 0; j < nodes; ++j) column[j] = c.w[0] * r0[j] + c.w[1] * r1[j];
    } else {
      for (std::size_t j = 0; j < nodes; ++j) column[j] = c.w[0] * r0[j];
    }
    double own = 0.0;
    for (int k = 0; k < c.count; ++k) own += c.w[k] * column[c.node[k] - first];
    c.inv_w = 1.0 / own;
    c.soft = numerics.recovery / (numerics.contact_N_per_m * dt_s * dt_s);
    c.inv_soft_w = 1.0 / (own + c.soft);
    column += nodes;
    c.target =
        c.gap_m > 0.0 ? -c.gap_m / dt_s : std::min(-numerics.recovery * c.gap_m / dt_s, numerics.max_recovery_m_per_s);
    c.p = in_cone(c.p, c.n, c.mu);
  }
}

template <bool Friction>
void ContactSet::sweep(int first, int nodes, const Vec* v) noexcept {
  Vec* const moved = moved_.data();  // velocities of the window as the metric sees them in the course of the sweep
  for (int j = 0; j < nodes; ++j) moved[j].v = v[first + j].v;
  const int count = static_cast<int>(contacts_.size());
  for (int index = 0; index < count; ++index) {
    Contact& c = contacts_[static_cast<std::size_t>(index)];
    Vec u = -c.surface;
    for (int j = 0; j < c.count; ++j) u += c.w[j] * moved[c.node[j] - first];
    const double un = dot(u, c.n), pn_before = dot(c.p, c.n);
    const double pn = pn_before - c.inv_soft_w * (un + c.soft * pn_before - c.target);
    Vec p{};
    if (pn > 0.0) {
      if constexpr (Friction) {
        const Vec pt = (c.p - pn_before * c.n) - c.inv_w * (u - un * c.n);
        const double size2 = dot(pt, pt), most = c.mu * pn;
        p = pn * c.n + (size2 > most * most ? most / std::sqrt(size2) : 1.0) * pt;
      } else {
        p = pn * c.n;
      }
    } else if (dot(c.p, c.p) == 0.0) {
      continue;
    }
    const Vec delta = p - c.p;
    c.p = p;
    for (int j = 0; j < c.count; ++j) extra_[static_cast<std::size_t>(c.node[j])] += c.w[j] * delta;
    const double* column = columns_.data() + static_cast<std::size_t>(index) * stride_;
    for (int j = 0; j < nodes; ++j) moved[j].v += column[j] * delta.v;
  }
}

template <bool Friction>
void ContactSet::settle(BandSolver& solver, const ContactMetric& metric, const Numerics& numerics, int passes,
                        double settled_m_per_s, double dt_s, int first, int last, Vec* v,
                        ContactReport& report) noexcept {
  const int nodes = last - first + 1;
  const auto clear = [&](std::vector<Vec>& array) {
    std::fill(array.begin() + first, array.begin() + last + 1, Vec{});
  };
  prepare(metric, first, last, numerics, dt_s);
  solver.solve(first, last, nullptr, v, true);
  for (auto& c : contacts_) c.u_free = velocity(c, v);
  clear(extra_);
  push(1.0);
  solver.solve(first, last, extra_.data(), step_.data(), false);
  add(first, last, v);
  const double settled2 = settled_m_per_s * settled_m_per_s;
  const std::size_t count = contacts_.size();
  mixing_.restart();
  for (int pass = 0; pass < passes; ++pass) {
    ++report.passes;
    clear(extra_);
    for (std::size_t k = 0; k < count; ++k) residual_[k] = contacts_[k].p;
    sweep<Friction>(first, nodes, v);
    solver.solve(first, last, extra_.data(), step_.data(), false);
    const double largest2 = add(first, last, v);
    if (largest2 < settled2 || pass + 1 >= passes) break;
    for (std::size_t k = 0; k < count; ++k) {
      plain_[k] = p_[k] = contacts_[k].p;
      residual_[k] = p_[k] - residual_[k];
    }
    if (!mixing_.step(p_.data(), residual_.data(), count)) continue;
    // The mixture, brought back into the cones, counts only if it is better than the plain pass.
    const double plain_merit = merit(v);
    clear(extra_);
    for (std::size_t k = 0; k < count; ++k) {
      Contact& c = contacts_[k];
      c.p = in_cone(p_[k], c.n, c.mu);
      const Vec delta = c.p - plain_[k];
      for (int j = 0; j < c.count; ++j) extra_[static_cast<std::size_t>(c.node[j])] += c.w[j] * delta;
    }
    solver.solve(first, last, extra_.data(), step_.data(), false);
    add(first, last, v);
    if (merit(v) <= plain_merit) continue;
    for (int i = first; i <= last; ++i) v[i] -= step_[static_cast<std::size_t>(i)];
    for (std::size_t k = 0; k < count; ++k) contacts_[k].p = plain_[k];
    mixing_.restart();
  }
}

void ContactSet::store() noexcept {
  for (const auto& c : contacts_) *c.keep = c.p;
}

void ContactSet::relabel(const std::vector<double>& s) noexcept {
  const auto segment = [&](double at) {
    const auto next = std::upper_bound(s.begin() + 1, s.end() - 1, at);
    return static_cast<std::int32_t>(next - s.begin()) - 1;
  };
  for (auto& pair : pairs) {
    if (dot(pair.impulse, pair.impulse) == 0.0) continue;
    pair.a = segment(pair.s_a);
    pair.b = segment(pair.s_b);
  }
}

template void ContactSet::settle<true>(BandSolver&, const ContactMetric&, const Numerics&, int, double, double, int,
                                       int, Vec*, ContactReport&) noexcept;
template void ContactSet::settle<false>(BandSolver&, const ContactMetric&, const Numerics&, int, double, double, int,
                                        int, Vec*, ContactReport&) noexcept;

}  // namespace ligature::physics::rod
