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
inline void eliminate(const Arrays& a, std::ptrdiff_t i, std::ptrdiff_t p, std::ptrdiff_t q, const Mat& a_ip,
                      double a_iq) noexcept {
  Mat s = a.diagonal[i];
  Vec r = a.rhs[i];
  if constexpr (Order > 0) {
    Mat f = a_ip;
    if constexpr (Order > 1) {
      f = f - a_iq * a.h[p];
      s = s - (a_iq * a_iq) * a.s_inverse[q];
      r -= a_iq * a.z[q];
    }
    a.f[i] = f;
    const Mat h = times_transposed(a.s_inverse[p], a.f[i]);
    a.h[i] = h;
    s = s - f * a.h[i];
    r -= f * a.z[p];
  }
  const Mat inverse = inverse_spd(s);
  a.s_inverse[i] = inverse;
  a.z[i] = inverse * r;
}

}  // namespace

void BandSolver::resize(int n) {
  n_ = n;
  const auto size = static_cast<std::size_t>(n);
  for (auto* array : {&diagonal, &couple, &f_, &h_, &s_inverse_}) array->resize(size);
  for (auto* array : {&rhs, &z_, &w_}) array->resize(size);
  skip.resize(size);
}

void BandSolver::factor(int first, int last) noexcept {
  assert(0 <= first && first <= last && last < n_);
  assert(first < last || first == 0 || last == n_ - 1);
  first_ = first;
  last_ = last;
  const Arrays a{diagonal.data(), rhs.data(), f_.data(), h_.data(), s_inverse_.data(), z_.data()};
  Mat* const e = couple.data();
  double* const b = skip.data();
  const auto left = [&](std::ptrdiff_t i) {
    if (i > 1) {
      eliminate<2>(a, i, i - 1, i - 2, e[i - 1], b[i - 2]);
    } else if (i == 1) {
      eliminate<1>(a, 1, 0, 0, e[0], 0.0);
    } else {
      eliminate<0>(a, 0, 0, 0, e[0], 0.0);
    }
  };
  const auto right = [&](std::ptrdiff_t i) {
    if (i + 2 < n_) {
      eliminate<2>(a, i, i + 1, i + 2, e[i], b[i]);
    } else if (i + 1 < n_) {
      eliminate<1>(a, i, i + 1, 0, e[i], 0.0);
    } else {
      eliminate<0>(a, i, 0, 0, e[i], 0.0);
    }
  };
  // Both ends in one loop: two independent chains of dependent arithmetic keep the core busy.
  const int lefts = first, rights = n_ - 1 - last;
  for (int k = 0; k < std::max(lefts, rights); ++k) {
    if (k < lefts) left(k);
    if (k < rights) right(n_ - 1 - k);
  }
  // The right-hand chain's Schur complement falls on the last two nodes of the window, which is why it has two.
  if (rights > 0) {
    const std::ptrdiff_t l = last, p = l + 1;
    Mat f = e[l];
    if (rights > 1) {
      f = f - b[l] * h_[static_cast<std::size_t>(p)];
      diagonal[static_cast<std::size_t>(l)] = a.diagonal[l] - (b[l] * b[l]) * a.s_inverse[p + 1];
      rhs[static_cast<std::size_t>(l)] -= b[l] * a.z[p + 1];
    }
    link_ = times_transposed(a.s_inverse[p], f);
    diagonal[static_cast<std::size_t>(l)] = a.diagonal[l] - f * link_;
    rhs[static_cast<std::size_t>(l)] -= f * a.z[p];
    if (l > 0) {
      const double c = b[l - 1];
      diagonal[static_cast<std::size_t>(l - 1)] = a.diagonal[l - 1] - (c * c) * a.s_inverse[p];
      e[l - 1] = e[l - 1] - c * transposed(link_);  // A(last, last - 1): not symmetric any more
      rhs[static_cast<std::size_t>(l - 1)] -= c * a.z[p];
    }
  }
  for (int i = first; i <= last; ++i) left(i);
}

void BandSolver::solve_window(const Vec* extra, Vec* out, bool base) noexcept {
  const Mat *f = f_.data(), *h = h_.data(), *s_inverse = s_inverse_.data();
  Vec* w = w_.data();
  const double* b = skip.data();
  if (extra != nullptr) {
    Vec z1{}, z2{};
    for (std::ptrdiff_t i = first_; i <= last_; ++i) {
      Vec r = extra[i];
      if (i > first_) r -= f[i] * z1;
      if (i > first_ + 1) r -= b[i - 2] * z2;
      z2 = z1;
      z1 = s_inverse[i] * r;
      w[i] = z1;
    }
  }
  for (std::ptrdiff_t i = last_; i >= first_; --i) {
    Vec x = extra != nullptr ? w[i] : Vec{};
    if (base) x += z_[static_cast<std::size_t>(i)];
    if (i + 2 <= last_) x -= b[i] * (s_inverse[i] * out[i + 2]);
    if (i + 1 <= last_) x -= h[i + 1] * out[i + 1];
    out[i] = x;
  }
}

void BandSolver::solve_outside(Vec* v) const noexcept {
  const Mat *h = h_.data(), *s_inverse = s_inverse_.data();
  const Vec* z = z_.data();
  const double* b = skip.data();
  const auto left = [&](std::ptrdiff_t i) {
    Vec x = z[i] - h[i + 1] * v[i + 1];
    if (i + 2 < n_) x -= b[i] * (s_inverse[i] * v[i + 2]);
    v[i] = x;
  };
  const auto right = [&](std::ptrdiff_t i) {
    Vec x = z[i] - (i == last_ + 1 ? link_ : h[i - 1]) * v[i - 1];
    if (i > 1) x -= b[i - 2] * (s_inverse[i] * v[i - 2]);
    v[i] = x;
  };
  const std::ptrdiff_t lefts = first_, rights = n_ - 1 - last_;
  for (std::ptrdiff_t k = 0; k < std::max(lefts, rights); ++k) {
    if (k < lefts) left(first_ - 1 - k);
    if (k < rights) right(last_ + 1 + k);
  }
}

}  // namespace ligature::physics::rod
