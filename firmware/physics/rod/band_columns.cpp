#include "firmware/physics/rod/band_columns.hpp"

#include <cassert>

#include "firmware/physics/rod/band_solver.hpp"
#include "firmware/physics/rod/swept.hpp"

namespace ligature::physics::rod {
void BandColumns::reserve() {
  constexpr auto kWide = static_cast<std::size_t>(kWidest);
  for (auto* array : {&f_, &s_inverse_, &one_, &two_, &x_}) array->resize(kWide);
  skip_.resize(kWide);
  place_.reserve(kWide);
  wanted_.reserve(kWide);
  columns_.resize(kBlock * kRoom);
}

void BandColumns::take(const BandSolver& solver, int first, int last) noexcept {
  assert(last - first < kWidest && first <= solver.core_ && solver.core_ + 1 <= last);
  first_ = first, last_ = last, made_ = 0;
  wanted_.clear();
  place_.assign(static_cast<std::size_t>(width()), -1);
  core_ = solver.core_ - first;
  const std::ptrdiff_t l = core_ + 1;
  for (std::ptrdiff_t i = 0; i < width(); ++i) {
    const std::ptrdiff_t at = first + i;
    put(f_[i], solver.f_[at]), put(s_inverse_[i], solver.s_inverse_[at]);
    skip_[i] = solver.skip[at];
    if (i < core_) put(one_[i], -1.0 * solver.h_[at + 1]), put(two_[i], -skip_[i] * s_inverse_[i]);
    if (i > l) {
      put(one_[i], -1.0 * (i == l + 1 ? solver.link_ : solver.h_[at - 1]));
      put(two_[i], -skip_[i - 2] * s_inverse_[i]);
    }
  }
  put(link_f_, solver.link_f_);
  put(core_h_, solver.h_[first + l]);
}

bool BandColumns::want(std::int32_t node) noexcept {
  std::int32_t& place = place_[static_cast<std::size_t>(node)];
  if (place >= 0) return true;
  if ((wanted_.size() + 1) * stride() > columns_.size()) return false;
  place = static_cast<std::int32_t>(wanted_.size());
  wanted_.push_back(node);
  return true;
}

// BandSolver::solve() with a unit right-hand side at one node: nothing between the ends and that node is eliminated.
void BandColumns::solve(std::ptrdiff_t node) noexcept {
  const std::ptrdiff_t core = core_, l = core + 1, wide = width();
  Mat* const x = x_.data();
  for (std::ptrdiff_t i = 0; i < wide; ++i) put(x[i], Mat{});
  const Mat unit = scaled_identity(1.0);
  Mat r = node == core ? unit : Mat{}, t = node == l ? unit : Mat{}, one{}, two{};
  if (node < core) {
    put(one, s_inverse_[node]), put(x[node], one);
    for (std::ptrdiff_t i = node + 1; i < core; ++i) {
      const Mat next = -1.0 * (s_inverse_[i] * (f_[i] * one + skip_[i - 2 < 0 ? 0 : i - 2] * two));
      put(two, one), put(one, next), put(x[i], one);
    }
    put(r, -1.0 * (f_[core] * one));
    if (core > 1) put(r, r - skip_[core - 2] * two);
    put(t, -skip_[core - 1] * one);
  } else if (node > l) {
    put(one, s_inverse_[node]), put(x[node], one);
    for (std::ptrdiff_t i = node - 1; i > l; --i) {
      const Mat next = -1.0 * (s_inverse_[i] * (f_[i] * one + skip_[i] * two));
      put(two, one), put(one, next), put(x[i], one);
    }
    put(r, -skip_[core] * one);
    put(t, -1.0 * (link_f_ * one + skip_[l] * two));
  }
  put(x[core], s_inverse_[core] * r);
  put(x[l], s_inverse_[l] * (t - f_[l] * x[core]));
  put(x[core], x[core] - core_h_ * x[l]);
  for (std::ptrdiff_t i = core - 1; i >= 0; --i) put(x[i], x[i] + one_[i] * x[i + 1] + two_[i] * x[i + 2]);
  for (std::ptrdiff_t i = l + 1; i < wide; ++i) put(x[i], x[i] + one_[i] * x[i - 1] + two_[i] * x[i - 2]);
}

void BandColumns::make_missing() noexcept {
  for (; missing() > 0; ++made_) {
    const auto single = [](Vec a) { return __builtin_convertvector(a.v, Four); };
    solve(wanted_[static_cast<std::size_t>(made_)]);
    float* at = columns_.data() + static_cast<std::size_t>(made_) * stride();
    for (std::ptrdiff_t i = 0; i < width(); ++i, at += kBlock)
      store_four(at, single(x_[i].x)), store_four(at + 4, single(x_[i].y)), store_four(at + 8, single(x_[i].z));
  }
}

}  // namespace ligature::physics::rod
