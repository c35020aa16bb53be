#include "firmware/physics/rod/solve/band_columns.hpp"

#include <algorithm>
#include <cassert>

#include "firmware/physics/rod/solve/band_solver.hpp"
#include "firmware/physics/rod/solve/node_velocities.hpp"

namespace ligature::physics::rod {
void BandColumns::reserve() {
  constexpr auto kWide = static_cast<std::size_t>(kWidest);
  for (auto* array : {&out_, &s_inverse_, &one_, &two_, &x_}) array->resize(kWide);
  skip_.resize(kWide);
  place_.reserve(kWide);
  wanted_.reserve(kWide);
  columns_.resize(kBlock * kRoom);
}

template <int Lane>
void BandColumns::take_chain(const BandSolver& solver, std::ptrdiff_t count) noexcept {
  const std::ptrdiff_t at_core = core_ + Lane, away = 2 * Lane - 1;
  put(out_[at_core], -1.0 * transposed(lane<Lane>(solver.core_h_)));
  for (std::ptrdiff_t k = 0; k < count; ++k) {
    const BandSolver::Step& step = solver.steps_[k];
    const Mat h = lane<Lane>(step.h), inverse = lane<Lane>(step.s_inverse);
    const std::ptrdiff_t i = at_core + away * (k + 1);
    put(s_inverse_[i], inverse);
    put(out_[i], -1.0 * transposed(h));
    put(two_[i], -step.skip[Lane] * inverse);
    if (k == 0) put(one_[i], -1.0 * lane<Lane>(solver.core_h_));
    if (k + 1 < count) put(one_[i + away], -1.0 * h);
  }
}

void BandColumns::take(const BandSolver& solver, int first, int last) noexcept {
  assert(last - first < kWidest && first <= solver.core_ && solver.core_ + 1 <= last);
  first_ = first, last_ = last, made_ = 0;
  wanted_.clear();
  place_.assign(static_cast<std::size_t>(width()), -1);
  core_ = solver.core_ - first;
  const std::ptrdiff_t l = core_ + 1;
  std::copy_n(solver.skip.data() + first, width(), skip_.data());
  take_chain<0>(solver, core_);
  take_chain<1>(solver, width() - 1 - l);
  put(s_inverse_[core_], solver.core_inverse_);
  put(s_inverse_[l], solver.next_inverse_);
  put(between_, solver.between_);
  put(next_h_, solver.next_h_);
}

bool BandColumns::want(std::int32_t node) noexcept {
  std::int32_t& place = place_[node];
  if (place >= 0) return true;
  if ((wanted_.size() + 1) * stride() > columns_.size()) return false;
  place = static_cast<std::int32_t>(wanted_.size());
  wanted_.push_back(node);
  return true;
}

// Computes the column of `node`, as BandSolver::solve() does for unit right-hand sides at that node. Right-hand sides
// further from the core (the two middle nodes) are zero, so elimination towards the core starts at `node`.
void BandColumns::solve(std::ptrdiff_t node) noexcept {
  const std::ptrdiff_t core = core_, l = core + 1, wide = width();
  Mat* const x = x_.data();
  for (std::ptrdiff_t i = 0; i < wide; ++i) put(x[i], Mat{});
  const Mat unit = scaled_identity(1.0);
  Mat r = node == core ? unit : Mat{}, t = node == l ? unit : Mat{}, y = unit, one{}, two{};
  if (node < core) {
    put(one, s_inverse_[node]), put(x[node], one);
    for (std::ptrdiff_t i = node + 1; i < core; ++i) {
      put(y, out_[i] * y - skip_[i - 2 < 0 ? 0 : i - 2] * two);
      put(two, one), put(one, s_inverse_[i] * y), put(x[i], one);
    }
    put(r, out_[core] * y);
    if (core > 1) put(r, r - skip_[core - 2] * two);
    put(t, -skip_[core - 1] * one);
  } else if (node > l) {
    put(one, s_inverse_[node]), put(x[node], one);
    for (std::ptrdiff_t i = node - 1; i > l; --i) {
      put(y, out_[i] * y - skip_[i] * two);
      put(two, one), put(one, s_inverse_[i] * y), put(x[i], one);
    }
    put(r, -skip_[core] * one);
    put(t, out_[l] * y - skip_[l] * two);
  }
  put(x[core], s_inverse_[core] * r);
  put(x[l], s_inverse_[l] * (t - between_ * x[core]));
  put(x[core], x[core] - next_h_ * x[l]);
  for (std::ptrdiff_t i = core - 1; i >= 0; --i) put(x[i], x[i] + one_[i] * x[i + 1] + two_[i] * x[i + 2]);
  for (std::ptrdiff_t i = l + 1; i < wide; ++i) put(x[i], x[i] + one_[i] * x[i - 1] + two_[i] * x[i - 2]);
}

bool BandColumns::make_missing(TickTime& time) noexcept {
  Pieces pieces(time);
  for (; missing() > 0; ++made_) {
    if (!pieces.allow(price::column(width()))) return false;
    const auto single = [](Vec a) { return __builtin_convertvector(a.v, Four); };
    solve(wanted_[made_]);
    float* at = columns_.data() + static_cast<std::size_t>(made_) * stride();
    for (std::ptrdiff_t i = 0; i < width(); ++i, at += kBlock)
      store_as(at, single(x_[i].x)), store_as(at + 4, single(x_[i].y)), store_as(at + 8, single(x_[i].z));
  }
  return true;
}

}  // namespace ligature::physics::rod
