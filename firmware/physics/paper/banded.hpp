#pragma once
// Symmetric positive definite systems of small bandwidth, solved in place by L D L^T. No pivoting is needed, because
// every matrix here is the identity plus a positive semidefinite matrix.

namespace ligature::physics {

/// Solves a tridiagonal system with scaled rows:
///   diag_i x_i - gain_i (link_i x_{i-1} + link_{i+1} x_{i+1}) = rhs_i,  i = 0 .. n - 1
/// The matrix is symmetric up to the factors gain_i of its rows, which may be zero.
/// @param diag  overwritten (inverse pivots)   @param link  link_i couples i - 1 and i   @param rhs  overwritten by x
/// Cost: 11 n operations, n divisions.
inline void solve_tridiagonal(int n, double* diag, const double* gain, const double* link, double* rhs) noexcept {
  if (n <= 0) return;
  double inverse = 1.0 / diag[0];
  diag[0] = inverse;
  double before = rhs[0];
#pragma GCC unroll 4
  for (int i = 1; i < n; ++i) {
    const double lower = gain[i] * link[i];
    const double l = lower * inverse;
    inverse = 1.0 / (diag[i] - l * gain[i - 1] * link[i]);
    diag[i] = inverse;
    before = rhs[i] + l * before;
    rhs[i] = before;
  }
  double next = rhs[n - 1] * diag[n - 1];
  rhs[n - 1] = next;
#pragma GCC unroll 4
  for (int i = n - 2; i >= 0; --i) {
    next = (rhs[i] + gain[i] * link[i + 1] * next) * diag[i];
    rhs[i] = next;
  }
}

/// Solves a symmetric pentadiagonal system: diag_i x_i + one_i x_{i+1} + two_i x_{i+2} + one_{i-1} x_{i-1} + two_{i-2}
/// x_{i-2} = rhs_i.
/// @param diag, one, two  overwritten (inverse pivots, columns of L D)   @param rhs  overwritten by x. Cost: 17 n
/// operations, n divisions.
inline void solve_pentadiagonal(int n, double* diag, double* one, double* two, double* rhs) noexcept {
  double inv1 = 0.0, inv2 = 0.0;  // inverse pivots of rows i-1, i-2
  double one1 = 0.0;              // reduced first off-diagonal of row i-1
  double two1 = 0.0, two2 = 0.0;  // second off-diagonals of rows i-1, i-2
  double y1 = 0.0, y2 = 0.0;
#pragma GCC unroll 4
  for (int i = 0; i < n; ++i) {
    const double l1 = one1 * inv1, l2 = two2 * inv2;
    const double inverse = 1.0 / (diag[i] - l1 * one1 - l2 * two2);
    const double y = rhs[i] - l1 * y1 - l2 * y2;
    const double reduced = one[i] - l1 * two1;
    diag[i] = inverse, one[i] = reduced, rhs[i] = y;
    inv2 = inv1, inv1 = inverse, one1 = reduced, two2 = two1, two1 = two[i], y2 = y1, y1 = y;
  }
  double x1 = 0.0, x2 = 0.0;
#pragma GCC unroll 4
  for (int i = n - 1; i >= 0; --i) {
    const double x =
        (rhs[i] - one[i] * x1 - two[i] * x2) * diag[i];  // x1 = x2 = 0 past the end: one, two need only be finite
    rhs[i] = x;
    x2 = x1, x1 = x;
  }
}

}  // namespace ligature::physics
