// A step of Newton's method: kinds of contact, the system they make, impulses that solve it.

#include <algorithm>
#include <cmath>
#include <utility>

#include "firmware/physics/rod/contact.hpp"
#include "firmware/physics/rod/contact_newton.hpp"

namespace ligature::physics::rod {

template <bool Friction>
double ContactNewton::read(const Contact* rows, const Vec* p, const Vec* u) noexcept {
  double largest2 = 0.0;
  changed_ = count_ = 0;
  for (const auto k : rows_) {
    const Contact& c = rows[k];
    Slot& slot = slots_[slot_of(k)];
    const double un = dot(u[k], c.n), pn = dot(p[k], c.n), lack = un + c.soft * pn - c.target;
    const double to_n = std::max(0.0, pn - slot.r_n * lack), error_n = (to_n - pn) / slot.r_n;
    const Vec pt = p[k] - pn * c.n;
    slot.q = pt - slot.r_t * (u[k] - un * c.n);
    slot.most = Friction ? c.mu * to_n : 0.0;
    const double size2 = dot(slot.q, slot.q);
    const bool sticks = size2 < slot.most * slot.most;
    const double share = sticks ? 1.0 : slot.most / std::max(std::sqrt(size2), 1e-300);
    const Vec error_t = (1.0 / slot.r_t) * (share * slot.q - pt);
    largest2 = std::max(largest2, error_n * error_n + dot(error_t, error_t));
    const Kind kind = to_n <= 0.0 ? Kind::kOpen : sticks ? Kind::kSticks : Kind::kSlides;
    changed_ += kind != std::exchange(slot.kind, kind);
    if (kind != Kind::kOpen) count_ += !Friction ? 1 : sticks ? 3 : 2;
  }
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
    answer(at, slots_.size(), step, true);
  }
  for (const auto k : rows_) u[k] += moved(slot_of(k));
}

// W x for an impulse x on one contact, the first `count` contacts at once: W is symmetric, so that is a sum of its
// rows.
void ContactNewton::answer(std::size_t slot, std::size_t count, Vec x, bool more) noexcept {
  const Eight x0 = all_eight(static_cast<float>(x[0])), x1 = all_eight(static_cast<float>(x[1])),
              x2 = all_eight(static_cast<float>(x[2]));
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

// W x for one impulse each, by slot.
void ContactNewton::answer_all(const Vec* change) noexcept {
  std::fill(on_.begin(), on_.end(), 0.0F);
  for (const auto k : rows_) {
    const std::size_t slot = slot_of(k);
    if (dot(change[slot], change[slot]) > 0.0) answer(slot, slots_.size(), change[slot], true);
  }
}

void ContactNewton::exchange(std::size_t a, std::size_t b) noexcept {
  std::swap(slots_[a], slots_[b]);
  for (const std::size_t s : {a, b}) {
    if (slots_[s].row >= 0) slot_[static_cast<std::size_t>(slots_[s].row)] = static_cast<std::int32_t>(s);
  }
  float* const w = w_.data();
  std::swap_ranges(w + 3 * a * kRow, w + 3 * (a + 1) * kRow, w + 3 * b * kRow);
  for (std::size_t at = 0, end = 3 * slots_.size() * kRow; at < end; at += kPlane) std::swap(w[at + a], w[at + b]);
}

// Contacts that carry load become the first ones, so that all that is known of them lies side by side.
void ContactNewton::bring_forward() noexcept {
  carrying_ = 0;
  for (const auto k : rows_) carrying_ += slots_[slot_of(k)].carries();
  std::size_t behind = slots_.size();
  for (std::size_t s = 0; s < carrying_; ++s) {
    if (slots_[s].carries()) continue;
    while (!slots_[--behind].carries()) {
    }
    exchange(s, behind);
  }
}

template <bool Friction>
void ContactNewton::list_unknowns(const Contact* rows, const Vec* p, const Vec* u) noexcept {
  constexpr double kCostNormal = 0.05, kCostAlong = 0.1;  // of a change at first, of what it does to its own contact
  constexpr double kHardly = 1e-6;                        // of q: what slides without friction turns freely
  unknowns_.clear();
  const auto add = [&](std::size_t s, Vec along, Vec with, double give, double cost, double wanted) {
    const std::int32_t k = slots_[s].row;
    const double now = dot(p[k], along);
    unknowns_.push_back({s, along, with, give + cost_ * cost, wanted - give * now - dot(along, u[k]), now});
  };
  const auto direction = [&](const Slot& slot) {
    const Vec n = rows[slot.row].n;
    if (const double size = norm(slot.q); size > 1e-30) return (1.0 / size) * slot.q;
    const Vec aside = std::abs(n[0]) < 0.7 ? make(1, 0, 0) : make(0, 1, 0), across = aside - dot(aside, n) * n;
    return (1.0 / norm(across)) * across;
  };
  for (std::size_t s = 0; s < carrying_; ++s) {
    const Slot& slot = slots_[s];
    const Contact& c = rows[slot.row];
    const bool slides = Friction && slot.kind == Kind::kSlides;
    const Vec with = slides ? c.n + c.mu * direction(slot) : c.n;
    add(s, c.n, with, c.soft, kCostNormal / slot.r_n, c.target);
    for (std::size_t i = 0; i < 3; ++i) with_[i][s] = static_cast<float>(with.v[i]);
  }
  if constexpr (Friction) {
    for (std::size_t s = 0; s < carrying_; ++s) {
      const Slot& slot = slots_[s];
      const Vec across = cross(rows[slot.row].n, direction(slot));
      const double share = std::max(kHardly, slot.most / std::max(norm(slot.q), 1e-300));
      const double give = slot.kind == Kind::kSticks ? 0.0 : (1.0 - share) / (share * slot.r_t);
      add(s, across, across, give, kCostAlong / slot.r_t, 0.0);
      for (std::size_t i = 0; i < 3; ++i) with_[i][kPlane + s] = static_cast<float>(across.v[i]);
    }
    for (std::size_t s = 0; s < carrying_; ++s) {
      const Slot& slot = slots_[s];
      if (slot.kind != Kind::kSticks) continue;
      const Vec along = direction(slot);
      add(s, along, along, 0.0, kCostAlong / slot.r_t, 0.0);
    }
  }
}

// Row i: along_i . W_ij with_j + give_i.
void ContactNewton::make_row(std::size_t i) noexcept {
  const Unknown& x = unknowns_[i];
  const std::size_t n = unknowns_.size();
  answer(x.slot, carrying_, x.along, false);
  const float* const on = on_.data();
  float* const row = dense_.row(i);
  const std::size_t planes = std::min<std::size_t>(n / std::max<std::size_t>(carrying_, 1), 2);
  for (std::size_t plane = 0; plane < planes; ++plane) {
    const float *const with_x = with_[0].data() + plane * kPlane, *const with_y = with_[1].data() + plane * kPlane,
                       *const with_z = with_[2].data() + plane * kPlane;
    float* const out = row + plane * carrying_;
    for (std::size_t s = 0; s < carrying_; s += 8)
      store_eight(out + s, load_eight(on + s) * load_eight(with_x + s) +
                               (load_eight(on + kPlane + s) * load_eight(with_y + s) +
                                load_eight(on + 2 * kPlane + s) * load_eight(with_z + s)));
  }
  for (std::size_t j = planes * carrying_; j < n; ++j) {
    const Vec with = unknowns_[j].with;
    const float* const at = on + unknowns_[j].slot;
    row[j] = static_cast<float>(with[0]) * at[0] +
             (static_cast<float>(with[1]) * at[kPlane] + static_cast<float>(with[2]) * at[2 * kPlane]);
  }
  std::fill(row + n, dense_.row_end(i), 0.0F);
  row[i] += static_cast<float>(x.give);
}

void ContactNewton::assemble(const Vec* p) noexcept {
  const std::size_t n = unknowns_.size();
  dense_.resize(n);
  for (std::size_t i = 0; i < n; ++i) make_row(i);
  // Of today's impulses, what the unknowns cannot say goes.
  for (const auto k : rows_) rest_[slot_of(k)].v = p[k].v;
  for (const auto& x : unknowns_) rest_[x.slot] -= x.now * x.with;
  answer_all(rest_.data());
  for (std::size_t i = 0; i < n; ++i) {
    const Unknown& x = unknowns_[i];
    dense_.row(i)[n] = static_cast<float>(x.wanted + dot(x.along, moved(x.slot)));
  }
}

template <bool Friction>
bool ContactNewton::solve(const Contact* rows, Vec* p, Vec* u) noexcept {
  constexpr double kFade = 0.15;  // of the cost of a change, from step to step
  constexpr int kAgain = 6;       // steps after which it begins anew
  cost_ = steps_ == 0 ? 1.0 : changed_ == 0 ? 0.0 : steps_ % kAgain == 0 ? 1.0 : kFade * cost_;
  ++steps_;
  bring_forward();
  list_unknowns<Friction>(rows, p, u);
  assemble(p);
  if (!dense_.solve()) return false;
  for (const auto k : rows_) rest_[slot_of(k)].v = -p[k].v, p[k] = Vec{};
  double sum = 0.0;
  for (std::size_t i = 0; i < unknowns_.size(); ++i) {
    const Unknown& x = unknowns_[i];
    p[slots_[x.slot].row] += (x.now + static_cast<double>(dense_.x(i))) * x.with;
    sum += static_cast<double>(dense_.x(i));
  }
  for (const auto k : rows_) rest_[slot_of(k)] += p[k];
  answer_all(rest_.data());
  for (const auto k : rows_) u[k] += moved(slot_of(k));
  return std::isfinite(sum);
}

template double ContactNewton::read<true>(const Contact*, const Vec*, const Vec*) noexcept;
template double ContactNewton::read<false>(const Contact*, const Vec*, const Vec*) noexcept;
template void ContactNewton::sweep<true>(const Contact*, Vec*, Vec*) noexcept;
template void ContactNewton::sweep<false>(const Contact*, Vec*, Vec*) noexcept;
template bool ContactNewton::solve<true>(const Contact*, Vec*, Vec*) noexcept;
template bool ContactNewton::solve<false>(const Contact*, Vec*, Vec*) noexcept;

}  // namespace ligature::physics::rod
