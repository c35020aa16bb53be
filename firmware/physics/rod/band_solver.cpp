#include "firmware/physics/rod/band_solver.hpp"

#include <algorithm>
#include <cassert>

namespace ligature::physics::rod {
namespace {

/// Where the recurrence of the header reads and writes; plain pointers, so that nothing is read twice.
struct Arrays {
  const Mat* diagonal;
  const Vec* rhs;
  Mat *f, *h, *s_inverse;
  Vec* z;
};

/// One step of the recurrence. @param p, q nodes eliminated just before i; Order: how many of them there are.
template <int Order>
[[gnu::always_inline]] inline void eliminate(const Arrays& a, std::ptrdiff_t i, std::ptrdiff_t p, std::ptrdiff_t q,
                                             const Mat& a_ip, double a_iq) noexcept {
  Mat s = a.diagonal[i];
  Vec r = a.rhs[i];
  if constexpr (Order > 0) {
    Mat f = a_ip;
    if constexpr (Order > 1) {
      f = f - a_iq * a.h[p];
      s = s - (a_iq * a_iq) * a.s_inverse[q];
      r -= a_iq * a.z[q];
    }
    put(a.f[i], f);
    const Mat h = times_transposed(a.s_inverse[p], f);
    put(a.h[i], h);
    s = s - f * h;
    r -= f * a.z[p];
  }
  const Mat inverse = inverse_spd(s);
  put(a.s_inverse[i], inverse);
  a.z[i].v = (inverse * r).v;
}

}  // namespace

void BandSolver::resize(int n) {
  n_ = n;
  const auto size = static_cast<std::size_t>(n);
  for (auto* array : {&diagonal, &couple, &f_, &h_, &s_inverse_}) array->resize(size);
  for (auto* array : {&rhs, &z_, &w_}) array->resize(size);
  skip.resize(size);
}

void BandSolver::factor(int core) noexcept {
  assert(0 <= core && core + 1 < n_);
  core_ = core;
  const Arrays a{diagonal.data(), rhs.data(), f_.data(), h_.data(), s_inverse_.data(), z_.data()};
  Mat *const d = diagonal.data(), *const e = couple.data();
  Vec* const r = rhs.data();
  double* const b = skip.data();
  const auto left = [&](std::ptrdiff_t i) {
    if (i == 0) {
      eliminate<0>(a, 0, 0, 0, e[0], 0.0);
    } else if (i == 1) {
      eliminate<1>(a, 1, 0, 0, e[0], 0.0);
    } else {
      eliminate<2>(a, i, i - 1, i - 2, e[i - 1], b[i - 2]);
    }
  };
  const std::ptrdiff_t n = n_, lefts = core, rights = n - 2 - core;
  for (std::ptrdiff_t i = 0; i < std::min<std::ptrdiff_t>(lefts, 2); ++i) left(i);
  if (rights > 0) eliminate<0>(a, n - 1, 0, 0, e[n - 1], 0.0);
  if (rights > 1) eliminate<1>(a, n - 2, n - 1, 0, e[n - 2], 0.0);
  std::ptrdiff_t i = 2, j = n - 3;  // two chains side by side, as far as both go
  for (; i < lefts && j > core + 1; ++i, --j) {
    eliminate<2>(a, i, i - 1, i - 2, e[i - 1], b[i - 2]);
    eliminate<2>(a, j, j + 1, j + 2, e[j], b[j]);
  }
  for (; i < lefts; ++i) eliminate<2>(a, i, i - 1, i - 2, e[i - 1], b[i - 2]);
  for (; j > core + 1; --j) eliminate<2>(a, j, j + 1, j + 2, e[j], b[j]);
  // The right-hand chain's Schur complement falls on both core nodes.
  if (rights > 0) {
    const std::ptrdiff_t l = core + 1, p = l + 1;
    Mat f = e[l];
    if (rights > 1) {
      f = f - b[l] * a.h[p];
      d[l] = d[l] - (b[l] * b[l]) * a.s_inverse[p + 1];
      r[l] -= b[l] * a.z[p + 1];
    }
    link_f_ = f;
    link_ = times_transposed(a.s_inverse[p], f);
    d[l] = d[l] - f * link_;
    r[l] -= f * a.z[p];
    const double c = b[l - 1];
    d[l - 1] = d[l - 1] - (c * c) * a.s_inverse[p];
    e[l - 1] = e[l - 1] - c * transposed(link_);  // A(core + 1, core): not symmetric any more
    r[l - 1] -= c * a.z[p];
  }
  left(core);
  left(core + 1);
}

void BandSolver::solve(int first, int last, const Vec* extra, Vec* out, bool base) noexcept {
  assert(first <= core_ && core_ + 1 <= last);
  const Mat *f = f_.data(), *h = h_.data(), *s_inverse = s_inverse_.data();
  const double* b = skip.data();
  Vec* w = w_.data();
  const std::ptrdiff_t core = core_, l = core + 1, lefts = core - first, rights = last - l;
  if (extra != nullptr) {
    Vec p1{}, p2{}, q1{}, q2{};  // w of the one and two nodes before, on the left and on the right
    for (std::ptrdiff_t k = 0; k < std::max(lefts, rights); ++k) {
      if (k < lefts) {
        const std::ptrdiff_t i = first + k;
        Vec r = extra[i];
        if (k > 0) r -= f[i] * p1;
        if (k > 1) r -= b[i - 2] * p2;
        p2 = p1;
        w[i] = p1 = s_inverse[i] * r;
      }
      if (k < rights) {
        const std::ptrdiff_t i = last - k;
        Vec r = extra[i];
        if (k > 0) r -= f[i] * q1;
        if (k > 1) r -= b[i] * q2;
        q2 = q1;
        w[i] = q1 = s_inverse[i] * r;
      }
    }
    Vec r = extra[core], t = extra[l];
    if (lefts > 0) r -= f[core] * p1;
    if (lefts > 1) r -= b[core - 2] * p2;
    if (rights > 0) r -= b[core] * q1, t -= link_f_ * q1;
    if (rights > 1) t -= b[l] * q2;
    if (lefts > 0) t -= b[l - 2] * p1;
    w[core] = s_inverse[core] * r;
    w[l] = s_inverse[l] * (t - f[l] * w[core]);
  } else {
    std::fill(w + first, w + last + 1, Vec{});
  }
  if (base) {
    for (std::ptrdiff_t i = first; i <= last; ++i) w[i] += z_[static_cast<std::size_t>(i)];
  }
  out[l] = w[l];
  out[core] = w[core] - h[l] * out[l];
  for (std::ptrdiff_t k = 0; k < std::max(lefts, rights); ++k) {
    if (k < lefts) {
      const std::ptrdiff_t i = core - 1 - k;
      out[i] = (w[i] - b[i] * (s_inverse[i] * out[i + 2])) - h[i + 1] * out[i + 1];
    }
    if (k < rights) {
      const std::ptrdiff_t i = l + 1 + k;
      out[i] = (w[i] - b[i - 2] * (s_inverse[i] * out[i - 2])) - (k == 0 ? link_ : h[i - 1]) * out[i - 1];
    }
  }
}

void BandSolver::solve_outside(int first, int last, Vec* v) const noexcept {
  const Mat *h = h_.data(), *s_inverse = s_inverse_.data();
  const Vec* z = z_.data();
  const double* b = skip.data();
  const std::ptrdiff_t l = core_ + 1, lefts = first, rights = n_ - 1 - last;
  for (std::ptrdiff_t k = 0; k < std::max(lefts, rights); ++k) {
    if (k < lefts) {
      const std::ptrdiff_t i = first - 1 - k;
      v[i] = (z[i] - b[i] * (s_inverse[i] * v[i + 2])) - h[i + 1] * v[i + 1];
    }
    if (k < rights) {
      const std::ptrdiff_t i = last + 1 + k;
      v[i] = (z[i] - b[i - 2] * (s_inverse[i] * v[i - 2])) - (i == l + 1 ? link_ : h[i - 1]) * v[i - 1];
    }
  }
}

}  // namespace ligature::physics::rod
