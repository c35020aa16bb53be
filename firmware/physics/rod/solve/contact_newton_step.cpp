// One step of Newton's method: determines the contacts' kinds, sets up the linear system for these kinds, and solves
// it.

#include <algorithm>
#include <cmath>
#include <utility>

#include "firmware/physics/rod/contact/contact_set.hpp"
#include "firmware/physics/rod/solve/contact_newton.hpp"
#include "firmware/physics/rod/tuning.hpp"

namespace ligature::physics::rod {

template <bool Friction>
double ContactNewton::read(const Contact* rows, const Vec* p, const Vec* u) noexcept {
  double largest2 = 0.0;
  count_ = 0;
  for (const auto k : rows_) {
    const Contact& c = rows[k];
    Slot& slot = slots_[slot_of(k)];
    const double un = dot(u[k], c.n), pn = dot(p[k], c.n), lack = un + c.soft * pn - c.target;
    const double to_n = std::max(0.0, pn - slot.r_n * lack), error_n = (to_n - pn) * slot.per_r_n;
    const Vec pt = p[k] - pn * c.n;
    slot.q = pt - slot.r_t * (u[k] - un * c.n);
    slot.most = Friction ? c.mu * to_n : 0.0;
    const double size2 = dot(slot.q, slot.q);
    const bool sticks = size2 < slot.most * slot.most;
    const double share = sticks ? 1.0 : slot.most / std::max(std::sqrt(size2), 1e-300);
    const Vec error_t = slot.per_r_t * (share * slot.q - pt);
    largest2 = std::max(largest2, error_n * error_n + dot(error_t, error_t));
    slot.kind = to_n <= 0.0 ? Kind::kOpen : sticks ? Kind::kSticks : Kind::kSlides;
    if (slot.kind != Kind::kOpen) count_ += !Friction ? 1 : sticks ? 3 : 2;
  }
  rises_ += largest2 > last2_;
  return last2_ = largest2;
}

template <bool Friction>
void ContactNewton::sweep(const Contact* rows, Vec* p, Vec* u) noexcept {
  on_.clear();
  for (const auto k : rows_) {
    const Contact& c = rows[k];
    const std::size_t at = slot_of(k);
    const Slot& slot = slots_[at];
    const Vec now = u[k] + moved(at);
    const double un = dot(now, c.n), pn = dot(p[k], c.n);
    const double to_n = std::max(0.0, pn - slot.r_n * (un + c.soft * pn - c.target));
    const Vec q = (p[k] - pn * c.n) - slot.r_t * (now - un * c.n);
    const Vec to = to_n * c.n + limited(q, Friction ? c.mu * to_n : 0.0), step = to - p[k];
    if (dot(step, step) == 0.0) continue;
    p[k].v = to.v;
    answer<false>(at, step, at, Vec{});
  }
  for (const auto k : rows_) u[k] += moved(slot_of(k));
}

// Adds to on_ the velocity changes of all slots by an impulse x on `slot` and, with `Two`, an impulse y on `other`. The
// coupling matrix W is symmetric, so its rows can be read instead of its columns.
template <bool Two>
void ContactNewton::answer(std::size_t slot, Vec x, std::size_t other, Vec y) noexcept {
  const Eight x0 = all_eight(static_cast<float>(x[0])), x1 = all_eight(static_cast<float>(x[1])),
              x2 = all_eight(static_cast<float>(x[2])), y0 = all_eight(static_cast<float>(y[0])),
              y1 = all_eight(static_cast<float>(y[1])), y2 = all_eight(static_cast<float>(y[2]));
  const std::size_t count = slots_.size();
  float* out = on_.data();
  for (std::size_t s = 0; s < count; s += kLanes) {
    const float *v = w_.block(slot, s), *w = w_.block(other, s);
    for (int j = 0; j < 3; ++j, v += kLanes, w += kLanes, out += kLanes) {
      Eight sum = x0 * load_as<Eight>(v) + x1 * load_as<Eight>(v + 3 * kLanes) + x2 * load_as<Eight>(v + 6 * kLanes);
      if constexpr (Two)
        sum += y0 * load_as<Eight>(w) + y1 * load_as<Eight>(w + 3 * kLanes) + y2 * load_as<Eight>(w + 6 * kLanes);
      store_as(out, load_as<Eight>(out) + sum);
    }
  }
}

// Sets on_ to the velocity changes of all slots by the impulses change[slot].
void ContactNewton::answer_all(const Vec* change) noexcept {
  constexpr auto kNone = static_cast<std::size_t>(-1);
  on_.clear();
  std::size_t waiting = kNone;  // slot to be paired with the next one
  for (const auto k : rows_) {
    const std::size_t slot = slot_of(k);
    if (dot(change[slot], change[slot]) == 0.0) continue;
    if (waiting == kNone) {
      waiting = slot;
      continue;
    }
    answer<true>(waiting, change[waiting], slot, change[slot]);
    waiting = kNone;
  }
  if (waiting != kNone) answer<false>(waiting, change[waiting], waiting, Vec{});
}

void ContactNewton::exchange(std::size_t a, std::size_t b) noexcept {
  std::swap(slots_[a], slots_[b]);
  for (const std::size_t s : {a, b}) {
    if (slots_[s].row >= 0) slot_[slots_[s].row] = static_cast<std::int32_t>(s);
  }
  w_.exchange(a, b, slots_.size());
}

std::size_t ContactNewton::carrying() const noexcept {
  return static_cast<std::size_t>(
      std::count_if(slots_.begin(), slots_.end(), [](const Slot& slot) { return slot.carries(); }));
}

int ContactNewton::exchanges() const noexcept {
  const auto end = slots_.begin() + static_cast<std::ptrdiff_t>(carrying());
  return static_cast<int>(std::count_if(slots_.begin(), end, [](const Slot& slot) { return !slot.carries(); }));
}

// Reorders the slots so that those that carry load come first, and their part of W is contiguous.
void ContactNewton::bring_forward() noexcept {
  carrying_ = carrying();
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
  const double proximal = tuning.proximal * std::max(1, rises_);
  constexpr double kHardly = 1e-6;  // least radius / |q| of a friction disc: bounds `give` at mu = 0
  unknowns_.clear();
  stuck_.clear();
  const auto add = [&](std::size_t s, Vec along, Vec with, double give, double damping, double wanted) {
    const std::int32_t k = slots_[s].row;
    const double now = dot(p[k], along);
    unknowns_.push_back({s, along, with, give + damping, wanted - give * now - dot(along, u[k]), now});
  };
  const auto direction = [&](const Slot& slot) {
    const Vec n = rows[slot.row].n;
    if (const double size = norm(slot.q); size > 1e-30) return (1.0 / size) * slot.q;
    const Vec aside = std::abs(n[0]) < 0.7 ? make(1, 0, 0) : make(0, 1, 0), across = aside - dot(aside, n) * n;
    return unit(across);
  };
  for (std::size_t s = 0; s < carrying_; ++s) {
    Slot& slot = slots_[s];
    const Contact& c = rows[slot.row];
    if constexpr (Friction) slot.along.v = direction(slot).v;
    const bool slides = Friction && slot.kind == Kind::kSlides;
    const Vec with = slides ? c.n + c.mu * slot.along : c.n;
    add(s, c.n, with, c.soft, proximal * slot.per_r_n, c.target);
    for (std::size_t i = 0; i < 3; ++i) with_.data()[i * kPlane + s] = static_cast<float>(with.v[i]);
  }
  if constexpr (Friction) {
    for (std::size_t s = 0; s < carrying_; ++s) {
      const Slot& slot = slots_[s];
      const Vec across = cross(rows[slot.row].n, slot.along);
      const double share = std::max(kHardly, slot.most / std::max(norm(slot.q), 1e-300));
      const double give = slot.kind == Kind::kSticks ? 0.0 : (1.0 - share) / share * slot.per_r_t;
      add(s, across, across, give, 2.0 * proximal * slot.per_r_t, 0.0);
      for (std::size_t i = 0; i < 3; ++i) with_.data()[(3 + i) * kPlane + s] = static_cast<float>(across.v[i]);
    }
    for (std::size_t s = 0; s < carrying_; ++s) {
      const Slot& slot = slots_[s];
      if (slot.kind != Kind::kSticks) continue;
      add(s, slot.along, slot.along, 0.0, 2.0 * proximal * slot.per_r_t, 0.0);
      stuck_.push_back(
          {s, static_cast<float>(slot.along[0]), static_cast<float>(slot.along[1]), static_cast<float>(slot.along[2])});
    }
  }
}

// Computes row i of the matrix: along_i . W_ij with_j for all unknowns j, and give_i added on the diagonal. The loop
// over contacts runs backwards, because a store of eight numbers may write past the last contact, into entries that are
// set later.
template <bool Friction>
[[gnu::always_inline]] inline void ContactNewton::make_row(std::size_t i) noexcept {
  const Unknown& unknown = unknowns_[i];
  const std::size_t n = unknowns_.size(), contacts = carrying_;
  const Eight a0 = all_eight(static_cast<float>(unknown.along[0])),
              a1 = all_eight(static_cast<float>(unknown.along[1])),
              a2 = all_eight(static_cast<float>(unknown.along[2]));
  const float* const with = with_.data();
  float *const row = dense_.row(i), *const on = on_.data();
  for (std::size_t s = (contacts + 7) & ~std::size_t{7}; s > 0;) {
    s -= 8;
    const float *const at = w_.block(unknown.slot, s), *const b = with + s;
    const auto plane = [&](std::size_t j) {
      const float* const w = at + j * kLanes;
      return a0 * load_as<Eight>(w) + a1 * load_as<Eight>(w + 3 * kLanes) + a2 * load_as<Eight>(w + 6 * kLanes);
    };
    const Eight x = plane(0), y = plane(1), z = plane(2);
    store_as(row + s, x * load_as<Eight>(b) + y * load_as<Eight>(b + kPlane) + z * load_as<Eight>(b + 2 * kPlane));
    if constexpr (Friction) {
      store_as(row + contacts + s, x * load_as<Eight>(b + 3 * kPlane) + y * load_as<Eight>(b + 4 * kPlane) +
                                       z * load_as<Eight>(b + 5 * kPlane));
      float* const moved = on + 3 * s;
      store_as(moved, x), store_as(moved + kLanes, y), store_as(moved + 2 * kLanes, z);
    }
  }
  float* out = row + (Friction ? 2 : 1) * contacts;
  for (const Stuck& stuck : stuck_) {
    const float* const at = on + on_at(stuck.slot);
    *out++ = at[0] * stuck.x + at[kLanes] * stuck.y + at[2 * kLanes] * stuck.z;
  }
  store_as(row + n, Eight{});
  row[i] += static_cast<float>(unknown.give);
}

template <bool Friction>
bool ContactNewton::assemble(const Vec* p, TickTime& time) noexcept {
  const std::size_t n = unknowns_.size();
  dense_.resize(n);
  Pieces pieces(time);
  for (std::size_t i = 0; i < n; ++i) {
    if (!pieces.allow(300 + 8 * static_cast<long>(n))) return false;
    make_row<Friction>(i);
  }
  // The step removes those parts of the present impulses for which the system has no unknown. The velocity change by
  // this removal enters the right-hand side
  for (const auto k : rows_) rest_[slot_of(k)].v = p[k].v;
  for (const auto& x : unknowns_) rest_[x.slot] -= x.now * x.with;
  answer_all(rest_.data());
  for (std::size_t i = 0; i < n; ++i) {
    const Unknown& x = unknowns_[i];
    dense_.row(i)[n] = static_cast<float>(x.wanted + dot(x.along, moved(x.slot)));
  }
  return true;
}

template <bool Friction>
bool ContactNewton::solve(const Contact* rows, Vec* p, Vec* u, TickTime& time) noexcept {
  bring_forward();
  list_unknowns<Friction>(rows, p, u);
  if (!assemble<Friction>(p, time) || !dense_.solve(time)) return false;
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
template bool ContactNewton::solve<true>(const Contact*, Vec*, Vec*, TickTime&) noexcept;
template bool ContactNewton::solve<false>(const Contact*, Vec*, Vec*, TickTime&) noexcept;

}  // namespace ligature::physics::rod
