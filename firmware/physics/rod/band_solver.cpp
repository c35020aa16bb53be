#include "firmware/physics/rod/band_solver.hpp"

#include <algorithm>
#include <cassert>

namespace ligature::physics::rod {

void BandSolver::resize(int n) {
  n_ = n;
  const auto size = static_cast<std::size_t>(n);
  diagonal.resize(size);
  couple.resize(size);
  skip.resize(size);
  rhs.resize(size);
  g_.resize(size);
  gt_.resize(size);
  s_inverse_.resize(size);
  y_.resize(size);
  w_.resize(size);
}

// One step of the recurrence of the header, and the same step for the right-hand side:
//   y_i = r_i - G_i y_p - A_iq S_q^-1 y_q. p < 0: first node of its end; q < 0: second.
void BandSolver::eliminate(int i, int p, int q, const Mat& a_ip, double a_iq) noexcept {
  const auto at = [](int k) { return static_cast<std::size_t>(k); };
  Mat s = diagonal[at(i)];
  Vec y = rhs[at(i)];
  if (p >= 0) {
    Mat f = a_ip;
    if (q >= 0) {
      f = f - a_iq * gt_[at(p)];
      s = s - (a_iq * a_iq) * s_inverse_[at(q)];
      y -= a_iq * (s_inverse_[at(q)] * y_[at(q)]);
    }
    const Mat g = f * s_inverse_[at(p)];
    g_[at(i)] = g;
    gt_[at(i)] = times_transposed(s_inverse_[at(p)], f);
    s = s - times_transposed(g, f);
    y -= g * y_[at(p)];
  }
  s_inverse_[at(i)] = inverse_spd(s);
  y_[at(i)] = y;
}

void BandSolver::factor(int first, int last) noexcept {
  assert(0 <= first && first <= last && last < n_);
  assert(first < last || first == 0 || last == n_ - 1);
  const auto at = [](int k) { return static_cast<std::size_t>(k); };
  first_ = first;
  last_ = last;
  // Both ends in one loop: two independent chains of dependent arithmetic keep the core busy.
  const auto left = [&](int i) {
    eliminate(i, i - 1, i - 2, i > 0 ? couple[at(i - 1)] : Mat{}, i > 1 ? skip[at(i - 2)] : 0.0);
  };
  const auto right = [&](int i) {
    const int p = i + 1 < n_ ? i + 1 : -1, q = i + 2 < n_ ? i + 2 : -1;
    eliminate(i, p, q, couple[at(i)], skip[at(i)]);
  };
  const int lefts = first, rights = n_ - 1 - last;
  for (int k = 0; k < std::max(lefts, rights); ++k) {
    if (k < lefts) left(k);
    if (k < rights) right(n_ - 1 - k);
  }
  // The right-hand chain's Schur complement falls on the last two nodes of the window, which is why it has two.
  if (last + 1 < n_) {
    const int p = last + 1;
    Mat f = couple[at(last)];
    Mat s = diagonal[at(last)];
    Vec r = rhs[at(last)];
    if (p + 1 < n_) {
      const double b = skip[at(last)];
      f = f - b * gt_[at(p)];
      s = s - (b * b) * s_inverse_[at(p + 1)];
      r -= b * (s_inverse_[at(p + 1)] * y_[at(p + 1)]);
    }
    const Mat g = f * s_inverse_[at(p)];
    link_ = times_transposed(s_inverse_[at(p)], f);
    diagonal[at(last)] = s - times_transposed(g, f);
    rhs[at(last)] = r - g * y_[at(p)];
    if (last > 0) {
      const double b = skip[at(last - 1)];
      diagonal[at(last - 1)] = diagonal[at(last - 1)] - (b * b) * s_inverse_[at(p)];
      couple[at(last - 1)] = couple[at(last - 1)] - b * link_;
      rhs[at(last - 1)] -= b * (s_inverse_[at(p)] * y_[at(p)]);
    }
  }
  for (int i = first; i <= last; ++i) left(i);
}

void BandSolver::solve_window(const Vec* extra, Vec* out, bool base) noexcept {
  const auto at = [](int k) { return static_cast<std::size_t>(k); };
  Vec z1{}, z2{}, y1{};  // S^-1 y of i-1 and i-2; y of i-1
  for (int i = first_; i <= last_; ++i) {
    Vec y = extra[i];
    if (i > first_) y -= g_[at(i)] * y1;
    if (i > first_ + 1) y -= skip[at(i - 2)] * z2;
    const Vec z = s_inverse_[at(i)] * y;
    w_[at(i)] = y;
    z2 = z1;
    z1 = z;
    y1 = y;
  }
  for (int i = last_; i >= first_; --i) {
    Vec y = w_[at(i)];
    if (base) y += y_[at(i)];
    if (i + 2 <= last_) y -= skip[at(i)] * out[i + 2];
    Vec x = s_inverse_[at(i)] * y;
    if (i + 1 <= last_) x -= gt_[at(i + 1)] * out[i + 1];
    out[i] = x;
  }
}

void BandSolver::solve_outside(Vec* v) const noexcept {
  const auto at = [](int k) { return static_cast<std::size_t>(k); };
  for (int i = first_ - 1; i >= 0; --i) {
    Vec y = y_[at(i)];
    if (i + 2 < n_) y -= skip[at(i)] * v[i + 2];
    v[i] = s_inverse_[at(i)] * y - gt_[at(i + 1)] * v[i + 1];
  }
  for (int i = last_ + 1; i < n_; ++i) {
    Vec y = y_[at(i)];
    if (i - 2 >= 0) y -= skip[at(i - 2)] * v[i - 2];
    Vec x = s_inverse_[at(i)] * y;
    x -= (i == last_ + 1 ? link_ : gt_[at(i - 1)]) * v[i - 1];
    v[i] = x;
  }
}

}  // namespace ligature::physics::rod
