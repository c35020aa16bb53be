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
  unknowns_.reserve(kUnknowns);
  on_.resize(kRow);
  rest_.resize(kRows);
  for (auto& array : with_) array.resize(2 * kPlane);
  dense_.reserve(kUnknowns);
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
  if (!put_off_) steps_ = 0;
  if (!put_off_ && 2 * slots_.size() > static_cast<std::size_t>(kMostRows)) slots_.clear(), coupled_ = 0;
  for (auto& slot : slots_) slot.row = -1;
  for (int k = 0; k < count; ++k) {
    const std::int32_t a = rows[k].node[0] - first_, b = rows[k].node[2] - first_;
    for (std::size_t s = 0; s < slots_.size(); ++s) {
      if (slots_[s].node[0] != a || slots_[s].node[2] != b || slots_[s].dead) continue;
      if (std::abs(rows[k].w[0] - slots_[s].w[0]) + std::abs(rows[k].w[3] - slots_[s].w[3]) > kMoved) {
        slots_[s].dead = true;
        break;
      }
      slot_[static_cast<std::size_t>(k)] = static_cast<std::int32_t>(s);
      slots_[s].row = k;
      rows_.push_back(k);
      break;
    }
  }
  for (std::size_t s = coupled_ == slots_.size() ? slots_.size() : 0; s-- > 0;) {
    if (!slots_[s].dead) continue;
    if (s + 1 != slots_.size()) exchange(s, slots_.size() - 1);
    slots_.pop_back();
    --coupled_;
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
  made.row = k;
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

bool ContactNewton::look(const Contact* rows, int count, const Vec* p, const Vec* u) noexcept {
  for (int k = 0; k < count; ++k) {
    if (slot_[static_cast<std::size_t>(k)] >= 0) continue;
    const Contact& c = rows[k];
    if (dot(u[k], c.n) >= c.target && dot(p[k], p[k]) == 0.0) continue;
    if (!take(rows, k)) return false;
  }
  return true;
}

}  // namespace ligature::physics::rod
