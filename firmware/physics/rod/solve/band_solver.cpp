#include "firmware/physics/rod/solve/band_solver.hpp"

#include <algorithm>
#include <cassert>

namespace ligature::physics::rod {
namespace {

constexpr Mat kNothing{}, kUnit{{kAxisX}, {kAxisY}, {kAxisZ}};  // blocks for a lane without a node

// F_i = A_ip - A_iq H_p (see the class BandSolver) for two nodes i at once, one left and one right of the core. e is
// A_ip, b is A_iq, h is H_p.
[[gnu::always_inline]] inline TwoMats towards(const TwoSyms& e, Two b, const TwoMats& h) noexcept {
  return {{e.xx - b * h.x.x, e.xy - b * h.x.y, e.xz - b * h.x.z},
          {e.xy - b * h.y.x, e.yy - b * h.y.y, e.yz - b * h.y.z},
          {e.xz - b * h.z.x, e.yz - b * h.z.y, e.zz - b * h.z.z}};
}

// The product a f^T; a is symmetric.
[[gnu::always_inline]] inline TwoMats times_transposed(const TwoSyms& a, const TwoMats& f) noexcept {
  return {a * Twos{f.x.x, f.y.x, f.z.x}, a * Twos{f.x.y, f.y.y, f.z.y}, a * Twos{f.x.z, f.y.z, f.z.z}};
}

// The product f g of two matrices whose product is symmetric.
[[gnu::always_inline]] inline TwoSyms product(const TwoMats& f, const TwoMats& g) noexcept {
  const Twos r0{f.x.x, f.y.x, f.z.x}, r1{f.x.y, f.y.y, f.z.y}, r2{f.x.z, f.y.z, f.z.z};
  return {dot(r0, g.x), dot(r1, g.x), dot(r2, g.x), dot(r1, g.y), dot(r2, g.y), dot(r2, g.z)};
}

}  // namespace

[[gnu::always_inline]] inline BandSolver::Pivot BandSolver::pivot_of(const TwoSyms& s) noexcept {
  const TwoSyms a = adjugate(s);
  return {a, 1.0 / (s.xx * a.xx + s.xy * a.xy + s.xz * a.xz)};
}

// Eliminates two nodes i at once, one left and one right of the core, by the formulas of the class BandSolver. For each
// of them p and q are the two nodes eliminated before it, and `pivot` is S_p^-1. Sets `h` to H_i (S_p^-1 times the
// block that couples p with i), and `y` from y_p to y_i (the right-hand side of i after elimination).
// @return S_i, the diagonal block of i after elimination.
[[gnu::always_inline]] inline TwoSyms BandSolver::eliminate(const Rows& a, const Step& p, Step& q, const Pivot& pivot,
                                                            TwoMats& h, Twos& y) noexcept {
  q.skip = a.skip;
  const TwoMats f = towards(a.couple, a.skip, p.h), g = times_transposed(pivot.adjugate, f);
  h = pivot.scale * g;
  y = less_transposed(a.rhs - a.skip * q.z, h, y);
  return a.diagonal - (a.skip * a.skip) * q.s_inverse - pivot.scale * product(f, g);
}

void BandSolver::resize(int n) {
  n_ = n;
  const auto size = static_cast<std::size_t>(n);
  for (auto* array : {&diagonal, &couple}) array->resize(size);
  rhs.resize(size);
  skip.resize(size);
  steps_.resize(size + 2);
  w_.resize(size);
}

std::ptrdiff_t BandSolver::steps() const noexcept { return std::max(core_, n_ - 2 - core_); }

[[gnu::always_inline]] inline BandSolver::Rows BandSolver::rows(std::ptrdiff_t k) const noexcept {
  const Mat *d = diagonal.data(), *e = couple.data();
  const double* b = skip.data();
  const Vec* r = rhs.data();
  const std::ptrdiff_t i = core_ - 1 - k, j = core_ + 2 + k, n = n_;
  if (i >= 2 && j <= n - 3) [[likely]]
    return {both(d[i], d[j]), both(e[i - 1], e[j]), Two{b[i - 2], b[j]}, both(r[i], r[j])};
  const Mat &d_left = i >= 0 ? d[i] : kUnit, &d_right = j < n ? d[j] : kUnit;
  const Mat &e_left = i >= 1 ? e[i - 1] : kNothing, &e_right = j < n - 1 ? e[j] : kNothing;
  const Vec &r_left = i >= 0 ? r[i] : kNothing.x, &r_right = j < n ? r[j] : kNothing.x;
  return {both(d_left, d_right), both(e_left, e_right), Two{i >= 2 ? b[i - 2] : 0.0, j < n - 2 ? b[j] : 0.0},
          both(r_left, r_right)};
}

void BandSolver::factor(int core) noexcept {
  assert(0 <= core && core + 1 < n_);
  core_ = core;
  Step* const step = steps_.data();
  const std::ptrdiff_t count = steps();
  step[count] = step[count + 1] = Step{};
  Pivot pivot;
  Twos y{};
  for (std::ptrdiff_t k = count - 1; k >= 0; --k) {
    Step& s = step[k];
    const TwoSyms left = eliminate(rows(k), step[k + 1], step[k + 2], pivot, s.h, y);
    pivot = pivot_of(left);
    s.s_inverse = pivot.scale * pivot.adjugate;
    s.z = s.s_inverse * y;
  }
  // The core: the two nodes where the eliminations from both ends meet. `skip` couples each core node with the second
  // next node, which is in the other half
  Step &one = step[0], &two = step[1];
  TwoSyms s = eliminate(rows(-1), one, two, pivot, core_h_, y);
  const Two across{core > 0 ? skip[static_cast<std::size_t>(core) - 1] : 0.0, core + 2 < n_ ? skip[core] : 0.0};
  one.skip = across;
  s = s - swapped((across * across) * one.s_inverse);
  y = y - swapped(across * one.z);
  between_ = couple[core] - across[0] * lane<0>(core_h_) - across[1] * transposed(lane<1>(core_h_));
  core_inverse_ = inverse_spd(lane<0>(s));
  next_h_ = rod::times_transposed(core_inverse_, between_);
  next_inverse_ = inverse_spd(lane<1>(s) - between_ * next_h_);
  core_z_ = core_inverse_ * lane<0>(y);
  next_z_ = next_inverse_ * (lane<1>(y) - between_ * core_z_);
}

void BandSolver::solve(int first, int last, const Vec* extra, Vec* out, bool base) noexcept {
  assert(first <= core_ && core_ + 1 <= last);
  const Step* const step = steps_.data();
  const std::ptrdiff_t core = core_, l = core + 1, lefts = core - first, rights = last - l;
  const std::ptrdiff_t count = std::max(lefts, rights);
  Vec at_core{}, at_next{};
  if (extra != nullptr) {
    Twos y{}, one{}, two{};  // y of the previous step; z of the previous step and of the one before it
    const auto pull = [&](std::ptrdiff_t i, std::ptrdiff_t j, const TwoMats& h, Two b) {
      const Twos r = both(i >= first ? extra[i] : Vec{}, j <= last ? extra[j] : Vec{});
      y = less_transposed(r - b * two, h, y);
    };
    for (std::ptrdiff_t k = count - 1; k >= 0; --k) {
      pull(core - 1 - k, l + 1 + k, step[k].h, step[k + 2].skip);
      two = one;
      w_[k] = one = step[k].s_inverse * y;
    }
    pull(core, l, core_h_, step[1].skip);
    y = y - swapped(step[0].skip * one);
    at_core = core_inverse_ * lane<0>(y);
    at_next = next_inverse_ * (lane<1>(y) - between_ * at_core);
  }
  if (base) at_core += core_z_, at_next += next_z_;
  out[l] = at_next;
  out[core] = at_core - next_h_ * at_next;
  Twos one = both(out[core], out[l]), two = swapped(one);
  for (std::ptrdiff_t k = 0; k < count; ++k) {
    Twos w = base ? step[k].z : Twos{};
    if (extra != nullptr) w = w + w_[k];
    const Twos x = substitute(k, w, one, two);
    two = one;
    one = x;
    if (k < lefts) out[core - 1 - k] = lane<0>(x);
    if (k < rights) out[l + 1 + k] = lane<1>(x);
  }
}

void BandSolver::solve_outside(int first, int last, Vec* v) const noexcept {
  const Step* const step = steps_.data();
  const std::ptrdiff_t l = core_ + 1, lefts = core_ - first, rights = last - l, n = n_;
  std::ptrdiff_t k = std::min(lefts, rights);
  Twos one = both(v[core_ - k], v[l + k]), two = both(v[l - k], v[core_ + k]);
  for (; k < steps(); ++k) {
    const std::ptrdiff_t i = core_ - 1 - k, j = l + 1 + k;
    const Twos x = substitute(k, step[k].z, one, two);
    if (k >= lefts && i >= 0) v[i] = lane<0>(x);
    if (k >= rights && j < n) v[j] = lane<1>(x);
    two = one;
    // At first, one side is still inside the window and already solved
    one = k < std::max(lefts, rights) ? both(k < lefts ? v[i] : lane<0>(x), k < rights ? v[j] : lane<1>(x)) : x;
  }
}

}  // namespace ligature::physics::rod
