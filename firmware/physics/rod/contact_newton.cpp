#include "firmware/physics/rod/contact_newton.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

#include "firmware/physics/rod/contact.hpp"

namespace ligature::physics::rod {

void ContactNewton::reserve() {
  constexpr auto kRows = static_cast<std::size_t>(kMostRows), kWide = static_cast<std::size_t>(kWidest);
  constexpr auto kUnknowns = static_cast<std::size_t>(kMostUnknowns);
  z_.resize(kWide * kWide);
  slot_.reserve(static_cast<std::size_t>(kMaxContacts));
  rows_.reserve(kRows);
  slots_.reserve(kRows);
  w_.resize(kRow * kRow);
  unknowns_.reserve(3 * kRows);
  on_.resize(kRow);
  all_.resize(kRow);
  rest_.resize(kRows);
  for (auto& array : with_) array.resize(kRow);
  place_.resize(3 * kRows);
  matrix_.resize(kUnknowns * (kUnknowns + 8));
  x_.resize(kUnknowns + 8);
}

void ContactNewton::measure(const BandSolver& solver, int first, int last) noexcept {
  assert(last - first < kWidest);
  first_ = first, last_ = last;
  solver.invert(first, last, z_.data(), kWidest);
  slots_.clear();
  coupled_ = 0;
  put_off_ = false;
}

void ContactNewton::start(const Contact* rows, int count) noexcept {
  constexpr double kMoved = 0.02;  // of a weight: a slot that has moved more is made anew
  slot_.assign(static_cast<std::size_t>(count), -1);
  rows_.clear();
  if (2 * slots_.size() > static_cast<std::size_t>(kMostRows)) slots_.clear(), coupled_ = 0, put_off_ = false;
  for (std::size_t s = 0; s < slots_.size(); ++s) {
    for (int k = 0; k < count; ++k) {
      if (rows[k].keep != slots_[s].who) continue;
      if (std::abs(rows[k].w[0] - slots_[s].w[0]) + std::abs(rows[k].w[3] - slots_[s].w[3]) > kMoved) break;
      slot_[static_cast<std::size_t>(k)] = static_cast<std::int32_t>(s);
      rows_.push_back(k);
      break;
    }
  }
}

void ContactNewton::put_off(const Contact* rows) noexcept {
  for (const auto k : rows_) slots_[static_cast<std::size_t>(slot_[static_cast<std::size_t>(k)])].guess.v = rows[k].p.v;
  put_off_ = true;
}

bool ContactNewton::resume(Vec* p) noexcept {
  for (const auto k : rows_) p[k].v = slots_[static_cast<std::size_t>(slot_[static_cast<std::size_t>(k)])].guess.v;
  return std::exchange(put_off_, false);
}

// Block (a, b) of J Z J^T. Z is symmetric and has its upper half: what lies below is summed on its own and turned.
Mat ContactNewton::block(const Slot& a, const Slot& b) const noexcept {
  Mat above{}, below{};
  for (int i = 0; i < a.count; ++i) {
    for (int j = 0; j < b.count; ++j) {
      const int p = a.node[i], q = b.node[j];
      const double weight = a.w[i] * b.w[j];
      const Mat& z = z_[static_cast<std::size_t>(std::min(p, q) * kWidest + std::max(p, q))];
      Mat& sum = p <= q ? above : below;
      sum.x.v += weight * z.x.v, sum.y.v += weight * z.y.v, sum.z.v += weight * z.z.v;
    }
  }
  return above + transposed(below);
}

void ContactNewton::keep(std::size_t slot, std::size_t other, const Mat& w) noexcept {
  for (std::size_t i = 0; i < 3; ++i) {
    const Lanes row = make(w.x[static_cast<int>(i)], w.y[static_cast<int>(i)], w.z[static_cast<int>(i)]).v;
    for (std::size_t j = 0; j < 3; ++j) {
      w_[(3 * slot + i) * kRow + j * kPlane + other] = static_cast<float>(row[j]);
      w_[(3 * other + j) * kRow + i * kPlane + slot] = static_cast<float>(row[j]);
    }
  }
}

// Row k may carry load: how far its map steps.
bool ContactNewton::take(const Contact* rows, int k) noexcept {
  const std::size_t slot = slots_.size();
  if (slot == static_cast<std::size_t>(kMostRows)) return false;
  slot_[static_cast<std::size_t>(k)] = static_cast<std::int32_t>(slot);
  rows_.push_back(k);
  const Contact& c = rows[k];
  Slot& made = slots_.emplace_back();
  made.who = c.keep;
  made.guess.v = c.p.v;
  made.count = c.count;
  for (int j = 0; j < c.count; ++j) made.node[j] = c.node[j] - first_, made.w[j] = c.w[j];
  const Mat own = block(made, made);
  keep(slot, slot, own);
  const Vec on_n = own * c.n;
  const double normal = dot(on_n, c.n);
  // Across n the block has trace t and squares s; its larger eigenvalue:
  const double t = own.x[0] + own.y[1] + own.z[2] - normal;
  const double s = dot(own.x, own.x) + dot(own.y, own.y) + dot(own.z, own.z) - 2.0 * dot(on_n, on_n) + normal * normal;
  const double across = 0.5 * (t + std::sqrt(std::max(0.0, 2.0 * s - t * t)));
  made.r_n = 1.0 / (normal + c.soft);
  made.r_t = 1.0 / across;
  return true;
}

// What new slots do to the others, and they to them.
void ContactNewton::couple() noexcept {
  for (; coupled_ < slots_.size(); ++coupled_) {
    for (std::size_t b = 0; b < coupled_; ++b) keep(coupled_, b, block(slots_[coupled_], slots_[b]));
  }
}

void ContactNewton::add(int row, Kind kind, Vec along, Vec with, double give, double wanted, double now) noexcept {
  const auto slot = static_cast<std::size_t>(slot_[static_cast<std::size_t>(row)]), plane = kind * kPlane;
  place_[unknowns_.size()] = static_cast<std::int32_t>(plane + slot);
  unknowns_.push_back({row, slot, along, with, give, wanted - give * now, now});
  for (std::size_t i = 0; i < 3; ++i) with_[i][plane + slot] = static_cast<float>(with.v[i]);
}

template <bool Friction>
double ContactNewton::look(const Contact* rows, int count, const Vec* u) noexcept {
  unknowns_.clear();
  double largest2 = 0.0;
  for (int k = 0; k < count; ++k) {
    const Contact& c = rows[k];
    const double un = dot(u[k], c.n), pn = dot(c.p, c.n), lack = un + c.soft * pn - c.target;
    if (slot_[static_cast<std::size_t>(k)] < 0) {
      if (lack >= 0.0 && dot(c.p, c.p) == 0.0) continue;
      if (!take(rows, k)) return -1.0;
    }
    const Slot& slot = slots_[static_cast<std::size_t>(slot_[static_cast<std::size_t>(k)])];
    const double to_n = std::max(0.0, pn - slot.r_n * lack), error_n = (to_n - pn) / slot.r_n;
    const Vec pt = c.p - pn * c.n, q = pt - slot.r_t * (u[k] - un * c.n);
    const double size2 = dot(q, q), most = Friction ? c.mu * to_n : 0.0;
    const bool sticks = size2 < most * most;
    const double size = std::sqrt(size2), share = sticks ? 1.0 : most / std::max(size, 1e-300);
    const Vec error_t = (1.0 / slot.r_t) * (share * q - pt);
    largest2 = std::max(largest2, error_n * error_n + dot(error_t, error_t));
    if (to_n <= 0.0) continue;
    // Directions across n: that of q, and the other one.
    const Vec aside = std::abs(c.n[0]) < 0.7 ? make(1, 0, 0) : make(0, 1, 0);
    const Vec raw = size > 1e-30 ? q : aside - dot(aside, c.n) * c.n;
    const Vec d = (1.0 / norm(raw)) * raw, e = cross(c.n, d);
    add(k, kNormal, c.n, sticks ? c.n : c.n + (most / to_n) * d, c.soft, c.target, pn);
    if (sticks) add(k, kAlong, d, d, 0.0, 0.0, dot(c.p, d));
    if (most > 0.0) add(k, kAcross, e, e, sticks ? 0.0 : (1.0 - share) / (share * slot.r_t), 0.0, dot(c.p, e));
  }
  for (auto& x : unknowns_) x.wanted -= dot(x.along, u[x.row]);
  return largest2;
}

// W x for an impulse x on one contact, all contacts at once: W is symmetric, so that is a sum of its rows.
void ContactNewton::answer(std::size_t slot, Vec x, bool more) noexcept {
  const Eight x0 = all_eight(static_cast<float>(x[0])), x1 = all_eight(static_cast<float>(x[1])),
              x2 = all_eight(static_cast<float>(x[2]));
  for (std::size_t plane = 0; plane < kRow; plane += kPlane) {
    const float* const w = w_.data() + 3 * slot * kRow + plane;
    float* const out = on_.data() + plane;
    for (std::size_t s = 0; s < slots_.size(); s += 8) {
      const Eight sum = x0 * load_eight(w + s) + (x1 * load_eight(w + kRow + s) + x2 * load_eight(w + 2 * kRow + s));
      store_eight(out + s, more ? load_eight(out + s) + sum : sum);
    }
  }
}

// matrix_ij = along_i . W_ij with_j + give_i: a row for all slots and kinds, then those that are unknown.
void ContactNewton::assemble(const Contact* rows) noexcept {
  const std::size_t n = unknowns_.size();
  stride_ = (n + 8) & ~std::size_t{7};
  for (std::size_t i = 0; i < n; ++i) {
    const Unknown& x = unknowns_[i];
    answer(x.slot, x.along, false);
    const float* const on = on_.data();
    for (std::size_t plane = 0; plane < kRow; plane += kPlane) {
      for (std::size_t s = 0; s < slots_.size(); s += 8) {
        store_eight(all_.data() + plane + s,
                    load_eight(on + s) * load_eight(with_[0].data() + plane + s) +
                        (load_eight(on + kPlane + s) * load_eight(with_[1].data() + plane + s) +
                         load_eight(on + 2 * kPlane + s) * load_eight(with_[2].data() + plane + s)));
      }
    }
    float* const __restrict row = matrix_.data() + i * stride_;
    const float* const __restrict all = all_.data();
    const std::int32_t* const __restrict place = place_.data();
    for (std::size_t j = 0; j < n; ++j) row[j] = all[place[j]];
    std::fill(row + n, row + stride_, 0.0F);
    row[i] += static_cast<float>(x.give);
  }
  // Of today's impulses, what the unknowns cannot say goes.
  for (const auto k : rows_) rest_[static_cast<std::size_t>(slot_[static_cast<std::size_t>(k)])].v = rows[k].p.v;
  for (const auto& x : unknowns_) rest_[x.slot] -= x.now * x.with;
  std::fill(on_.begin(), on_.end(), 0.0F);
  for (const auto k : rows_) {
    const auto slot = static_cast<std::size_t>(slot_[static_cast<std::size_t>(k)]);
    if (dot(rest_[slot], rest_[slot]) > 0.0) answer(slot, rest_[slot], true);
  }
  for (std::size_t i = 0; i < n; ++i) {
    const Unknown& x = unknowns_[i];
    const float* const u = on_.data() + x.slot;
    matrix_[i * stride_ + n] = static_cast<float>(x.wanted + dot(x.along, make(u[0], u[kPlane], u[2 * kPlane])));
  }
}

// Gaussian elimination with row pivots, eight columns of four rows at a time; the right-hand side is a column.
bool ContactNewton::eliminate() noexcept {
  const std::size_t n = unknowns_.size(), stride = stride_;
  float* const m = matrix_.data();
  for (std::size_t k = 0; k < n; ++k) {
    std::size_t best = k;
    float largest = std::abs(m[k * stride + k]);
    for (std::size_t i = k + 1; i < n; ++i) {
      const float size = std::abs(m[i * stride + k]);
      if (size > largest) largest = size, best = i;
    }
    if (!(largest > 0.0F)) return false;
    if (best != k)
      std::swap_ranges(m + k * stride + (k & ~std::size_t{7}), m + (k + 1) * stride,
                       m + best * stride + (k & ~std::size_t{7}));
    const float* const top = m + k * stride;
    const float inverse = 1.0F / top[k];
    const std::size_t from = (k + 1) & ~std::size_t{7};  // what lies to the left of k + 1 is not read again
    std::size_t i = k + 1;
    for (; i + 3 < n; i += 4) {
      float *const a = m + i * stride, *const b = a + stride, *const c = b + stride, *const d = c + stride;
      const Eight fa = all_eight(a[k] * inverse), fb = all_eight(b[k] * inverse), fc = all_eight(c[k] * inverse),
                  fd = all_eight(d[k] * inverse);
      for (std::size_t j = from; j < stride; j += 8) {
        const Eight t = load_eight(top + j);
        store_eight(a + j, load_eight(a + j) - fa * t);
        store_eight(b + j, load_eight(b + j) - fb * t);
        store_eight(c + j, load_eight(c + j) - fc * t);
        store_eight(d + j, load_eight(d + j) - fd * t);
      }
    }
    for (; i < n; ++i) {
      float* const a = m + i * stride;
      const Eight f = all_eight(a[k] * inverse);
      for (std::size_t j = from; j < stride; j += 8) store_eight(a + j, load_eight(a + j) - f * load_eight(top + j));
    }
  }
  return true;
}

void ContactNewton::substitute() noexcept {
  const std::size_t n = unknowns_.size();
  std::fill(x_.begin(), x_.end(), 0.0F);
  for (std::size_t k = n; k-- > 0;) {
    const float* const row = matrix_.data() + k * stride_;
    Eight sum{};
    for (std::size_t j = (k + 1) & ~std::size_t{7}; j < n; j += 8)
      sum += load_eight(row + j) * load_eight(x_.data() + j);
    // x_ is zero up to k, so what elimination left there does not count; the right-hand side is in column n
    const float known = ((sum[0] + sum[4]) + (sum[1] + sum[5])) + ((sum[2] + sum[6]) + (sum[3] + sum[7]));
    x_[k] = (row[n] - known) / row[k];
  }
}

bool ContactNewton::solve(const Contact* rows, int count, Vec* p) noexcept {
  couple();
  assemble(rows);
  if (!eliminate()) return false;
  substitute();
  std::fill(p, p + count, Vec{});
  double sum = 0.0;
  for (std::size_t i = 0; i < unknowns_.size(); ++i) {
    p[unknowns_[i].row] += (unknowns_[i].now + static_cast<double>(x_[i])) * unknowns_[i].with;
    sum += static_cast<double>(x_[i]);
  }
  return std::isfinite(sum);
}

template double ContactNewton::look<true>(const Contact*, int, const Vec*) noexcept;
template double ContactNewton::look<false>(const Contact*, int, const Vec*) noexcept;

}  // namespace ligature::physics::rod
