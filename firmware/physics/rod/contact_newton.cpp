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
  unknowns_.clear();
  if (!put_off_ && 2 * slots_.size() > static_cast<std::size_t>(kMostRows)) slots_.clear(), coupled_ = 0;
  for (int k = 0; k < count; ++k) {
    const std::int32_t a = rows[k].node[0] - first_, b = rows[k].node[2] - first_;
    for (std::size_t s = 0; s < slots_.size(); ++s) {
      if (slots_[s].node[0] != a || slots_[s].node[2] != b || slots_[s].dead) continue;
      if (std::abs(rows[k].w[0] - slots_[s].w[0]) + std::abs(rows[k].w[3] - slots_[s].w[3]) > kMoved) {
        slots_[s].dead = true;
        break;
      }
      slot_[static_cast<std::size_t>(k)] = static_cast<std::int32_t>(s);
      rows_.push_back(k);
      break;
    }
  }
}

void ContactNewton::put_off(const Vec* p) noexcept {
  for (const auto k : rows_) slots_[slot_of(k)].guess.v = p[k].v;
  put_off_ = true;
}

bool ContactNewton::resume(Vec* p) noexcept {
  if (put_off_) {
    for (const auto k : rows_) p[k].v = slots_[slot_of(k)].guess.v;
  }
  return std::exchange(put_off_, false);
}

// Block (a, b) of J Z J^T, segment by segment. Z is symmetric and has its upper half: what lies below is summed on its
// own and turned.
Mat ContactNewton::block(const Slot& a, const Slot& b) const noexcept {
  constexpr auto kWide = static_cast<std::ptrdiff_t>(kWidest);
  Mat above{}, below{};
  const auto add = [](Mat& sum, double weight, const Mat& z) {
    sum.x.v += weight * z.x.v, sum.y.v += weight * z.y.v, sum.z.v += weight * z.z.v;
  };
  for (int i = 0; i < a.count; i += 2) {
    for (int j = 0; j < b.count; j += 2) {
      const std::ptrdiff_t p = a.node[i], q = b.node[j];
      const double w00 = a.w[i] * b.w[j], w01 = a.w[i] * b.w[j + 1], w10 = a.w[i + 1] * b.w[j],
                   w11 = a.w[i + 1] * b.w[j + 1];
      if (p < q) {
        const Mat* const z = z_.data() + p * kWide + q;
        add(above, w00, z[0]), add(above, w01, z[1]), add(above, w10, z[kWide]), add(above, w11, z[kWide + 1]);
      } else if (q < p) {
        const Mat* const z = z_.data() + q * kWide + p;
        add(below, w00, z[0]), add(below, w10, z[1]), add(below, w01, z[kWide]), add(below, w11, z[kWide + 1]);
      } else {
        const Mat* const z = z_.data() + p * kWide + p;
        add(above, w00, z[0]), add(above, w01, z[1]), add(below, w10, z[1]), add(above, w11, z[kWide + 1]);
      }
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

bool ContactNewton::look(const Contact* rows, int count, const Vec* p, const Vec* u) noexcept {
  for (int k = 0; k < count; ++k) {
    if (slot_[static_cast<std::size_t>(k)] >= 0) continue;
    const Contact& c = rows[k];
    if (dot(u[k], c.n) >= c.target && dot(p[k], p[k]) == 0.0) continue;
    if (!take(rows, k)) return false;
  }
  return true;
}

template <bool Friction>
double ContactNewton::read(const Contact* rows, const Vec* p, const Vec* u) noexcept {
  unknowns_.clear();
  double largest2 = 0.0;
  for (const auto k : rows_) {
    const Contact& c = rows[k];
    const Slot& slot = slots_[slot_of(k)];
    const double un = dot(u[k], c.n), pn = dot(p[k], c.n), lack = un + c.soft * pn - c.target;
    const double to_n = std::max(0.0, pn - slot.r_n * lack), error_n = (to_n - pn) / slot.r_n;
    const Vec pt = p[k] - pn * c.n, q = pt - slot.r_t * (u[k] - un * c.n);
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
    if (sticks) add(k, kAlong, d, d, 0.0, 0.0, dot(p[k], d));
    if (most > 0.0) add(k, kAcross, e, e, sticks ? 0.0 : (1.0 - share) / (share * slot.r_t), 0.0, dot(p[k], e));
  }
  for (auto& x : unknowns_) x.wanted -= dot(x.along, u[x.row]);
  return largest2;
}

template <bool Friction>
void ContactNewton::sweep(const Contact* rows, Vec* p, Vec* u) noexcept {
  std::fill(on_.begin(), on_.end(), 0.0F);
  for (const auto k : rows_) {
    const Contact& c = rows[k];
    const std::size_t at = slot_of(k);
    const Slot& slot = slots_[at];
    const Vec now = u[k] + moved(at);
    const double un = dot(now, c.n), pn = dot(p[k], c.n);
    const double to_n = std::max(0.0, pn - slot.r_n * (un + c.soft * pn - c.target));
    const Vec q = (p[k] - pn * c.n) - slot.r_t * (now - un * c.n);
    const double size2 = dot(q, q), most = Friction ? c.mu * to_n : 0.0;
    const Vec to = to_n * c.n + (size2 > most * most ? most / std::sqrt(size2) : 1.0) * q, step = to - p[k];
    if (dot(step, step) == 0.0) continue;
    p[k].v = to.v;
    answer(at, step, true);
  }
  for (const auto k : rows_) u[k] += moved(slot_of(k));
}

// W x for an impulse x on one contact, all contacts at once: W is symmetric, so that is a sum of its rows.
void ContactNewton::answer(std::size_t slot, Vec x, bool more) noexcept {
  const Eight x0 = all_eight(static_cast<float>(x[0])), x1 = all_eight(static_cast<float>(x[1])),
              x2 = all_eight(static_cast<float>(x[2]));
  const std::size_t count = slots_.size();  // read once: a store might change anything, as far as a compiler knows
  const float* const from = w_.data() + 3 * slot * kRow;
  float* const to = on_.data();
  for (std::size_t plane = 0; plane < kRow; plane += kPlane) {
    const float* const w = from + plane;
    float* const out = to + plane;
    for (std::size_t s = 0; s < count; s += 8) {
      const Eight sum = x0 * load_eight(w + s) + (x1 * load_eight(w + kRow + s) + x2 * load_eight(w + 2 * kRow + s));
      store_eight(out + s, more ? load_eight(out + s) + sum : sum);
    }
  }
}

// matrix_ij = along_i . W_ij with_j + give_i: a row for all slots and kinds, then those that are unknown.
void ContactNewton::assemble(const Vec* p) noexcept {
  const std::size_t n = unknowns_.size(), count = slots_.size(), stride = (n + 8) & ~std::size_t{7};
  stride_ = stride;
  const float* const on = on_.data();
  const float *const with_x = with_[0].data(), *const with_y = with_[1].data(), *const with_z = with_[2].data();
  float* const all = all_.data();
  const std::int32_t* const place = place_.data();
  const Unknown* const unknown = unknowns_.data();
  for (std::size_t i = 0; i < n; ++i) {
    const Unknown& x = unknown[i];
    answer(x.slot, x.along, false);
    for (std::size_t s = 0; s < count; s += 8) {
      const Eight u = load_eight(on + s), v = load_eight(on + kPlane + s), w = load_eight(on + 2 * kPlane + s);
      for (std::size_t at = s; at < kRow; at += kPlane)
        store_eight(all + at,
                    u * load_eight(with_x + at) + (v * load_eight(with_y + at) + w * load_eight(with_z + at)));
    }
    float* const __restrict row = matrix_.data() + i * stride;
    const float* const __restrict source = all;
    for (std::size_t j = 0; j < n; ++j) row[j] = source[place[j]];
    std::fill(row + n, row + stride, 0.0F);
    row[i] += static_cast<float>(x.give);
  }
  // Of today's impulses, what the unknowns cannot say goes.
  for (const auto k : rows_) rest_[slot_of(k)].v = p[k].v;
  for (const auto& x : unknowns_) rest_[x.slot] -= x.now * x.with;
  std::fill(on_.begin(), on_.end(), 0.0F);
  for (const auto k : rows_) {
    const std::size_t slot = slot_of(k);
    if (dot(rest_[slot], rest_[slot]) > 0.0) answer(slot, rest_[slot], true);
  }
  for (std::size_t i = 0; i < n; ++i) {
    const Unknown& x = unknowns_[i];
    matrix_[i * stride + n] = static_cast<float>(x.wanted + dot(x.along, moved(x.slot)));
  }
}

// Brings the row below with the largest entry of column k up, and clears that column under it.
bool ContactNewton::pivot(std::size_t k) noexcept {
  const std::size_t n = unknowns_.size(), stride = stride_, from = k & ~std::size_t{7};
  float* const m = matrix_.data();
  std::size_t best = k;
  for (std::size_t i = k + 1; i < n; ++i) {
    if (std::abs(m[i * stride + k]) > std::abs(m[best * stride + k])) best = i;
  }
  if (best != k) std::swap_ranges(m + k * stride + from, m + (k + 1) * stride, m + best * stride + from);
  const float* const top = m + k * stride;
  if (!(std::abs(top[k]) > 0.0F)) return false;
  for (std::size_t i = k + 1; i < n; ++i) {
    float* const a = m + i * stride;
    const Eight f = all_eight(a[k] / top[k]);
    for (std::size_t j = from; j < stride; j += 8) store_eight(a + j, load_eight(a + j) - f * load_eight(top + j));
  }
  return true;
}

// Four pivots from row k on, cleared among themselves. @return false when one has shrunk, and nothing is lost.
bool ContactNewton::panel(std::size_t k) noexcept {
  constexpr float kShrunk = 1e-4F;
  const std::size_t stride = stride_, from = k & ~std::size_t{7};
  float* const m = matrix_.data() + k * stride;
  for (std::size_t i = 0; i < kPanel; ++i) {
    float* const a = m + i * stride;
    const float whole = kShrunk * std::abs(a[k + i]);
    for (std::size_t p = 0; p < i; ++p) {
      const float* const top = m + p * stride;
      const Eight factor = all_eight(a[k + p] / top[k + p]);
      for (std::size_t j = from; j < stride; j += 8)
        store_eight(a + j, load_eight(a + j) - factor * load_eight(top + j));
    }
    if (!(std::abs(a[k + i]) > whole)) return false;
  }
  return true;
}

namespace {

using Four = float __attribute__((vector_size(16)));

/// Inverse of the upper triangle of a panel: what a row has in its four columns, times that, is what to take of each of
/// its rows.
struct Triangle {
  Four row[4];

  Triangle(const float* m, std::size_t stride) noexcept {
    for (int i = 0; i < 4; ++i) {
      row[i] = Four{};
      row[i][i] = 1.0F;
    }
    for (std::size_t j = 0; j < 4; ++j) {  // column by column: X U = I
      for (std::size_t i = 0; i <= j; ++i) {
        float x = i == j ? 1.0F : 0.0F;
        for (std::size_t q = i; q < j; ++q) x -= row[i][static_cast<int>(q)] * m[q * stride + j];
        row[i][static_cast<int>(j)] = x / m[j * stride + j];
      }
    }
  }
  [[nodiscard]] Four of(const float* a) const noexcept {
    return (a[0] * row[0] + a[1] * row[1]) + (a[2] * row[2] + a[3] * row[3]);
  }
};

}  // namespace

// Gaussian elimination, four pivots, two rows and eight columns at a time; the right-hand side is a column. Rows change
// places only where a pivot has shrunk: nearly all of them are those of a symmetric positive matrix.
bool ContactNewton::eliminate() noexcept {
  const std::size_t n = unknowns_.size(), stride = stride_;
  std::size_t k = 0;
  while (k < n) {
    if (k + kPanel > n || !panel(k)) {
      if (!pivot(k++)) return false;
      continue;
    }
    const float* const t = matrix_.data() + k * stride;
    const Triangle triangle(t + k, stride);
    const std::size_t from = (k + kPanel) & ~std::size_t{7};  // what lies to the left of k + 4 is not read again
    std::size_t i = k + kPanel;
    for (; i + 1 < n; i += 2) {
      float *const a = matrix_.data() + i * stride, *const b = a + stride;
      const Four f = triangle.of(a + k), g = triangle.of(b + k);
      const Eight f0 = all_eight(f[0]), f1 = all_eight(f[1]), f2 = all_eight(f[2]), f3 = all_eight(f[3]);
      const Eight g0 = all_eight(g[0]), g1 = all_eight(g[1]), g2 = all_eight(g[2]), g3 = all_eight(g[3]);
      for (std::size_t j = from; j < stride; j += 8) {
        const Eight t0 = load_eight(t + j), t1 = load_eight(t + stride + j), t2 = load_eight(t + 2 * stride + j),
                    t3 = load_eight(t + 3 * stride + j);
        store_eight(a + j, (((load_eight(a + j) - f0 * t0) - f1 * t1) - f2 * t2) - f3 * t3);
        store_eight(b + j, (((load_eight(b + j) - g0 * t0) - g1 * t1) - g2 * t2) - g3 * t3);
      }
    }
    for (; i < n; ++i) {
      float* const a = matrix_.data() + i * stride;
      const Four f = triangle.of(a + k);
      for (std::size_t p = 0; p < kPanel; ++p) {
        const Eight factor = all_eight(f[static_cast<int>(p)]);
        for (std::size_t j = from; j < stride; j += 8)
          store_eight(a + j, load_eight(a + j) - factor * load_eight(t + p * stride + j));
      }
    }
    k += kPanel;
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

bool ContactNewton::solve(Vec* p, Vec* u) noexcept {
  assemble(p);
  if (!eliminate()) return false;
  substitute();
  for (const auto k : rows_) rest_[slot_of(k)].v = -p[k].v, p[k] = Vec{};
  double sum = 0.0;
  for (std::size_t i = 0; i < unknowns_.size(); ++i) {
    p[unknowns_[i].row] += (unknowns_[i].now + static_cast<double>(x_[i])) * unknowns_[i].with;
    sum += static_cast<double>(x_[i]);
  }
  std::fill(on_.begin(), on_.end(), 0.0F);
  for (const auto k : rows_) {
    const Vec step = p[k] + rest_[slot_of(k)];
    if (dot(step, step) > 0.0) answer(slot_of(k), step, true);
  }
  for (const auto k : rows_) u[k] += moved(slot_of(k));
  return std::isfinite(sum);
}

template double ContactNewton::read<true>(const Contact*, const Vec*, const Vec*) noexcept;
template double ContactNewton::read<false>(const Contact*, const Vec*, const Vec*) noexcept;
template void ContactNewton::sweep<true>(const Contact*, Vec*, Vec*) noexcept;
template void ContactNewton::sweep<false>(const Contact*, Vec*, Vec*) noexcept;

}  // namespace ligature::physics::rod
