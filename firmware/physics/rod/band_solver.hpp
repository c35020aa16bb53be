#pragma once
// The linear system of one substep: block pentadiagonal, symmetric positive definite, solved from both ends inwards.

#include <vector>

#include "firmware/physics/rod/vec.hpp"

namespace ligature::physics::rod {

/// A v = r for n nodes with 3 x 3 blocks
///   A(i, i) = diagonal[i],  A(i, i+1) = couple[i] (symmetric),  A(i, i+2) = skip[i] I.
/// Block LDL^T from both ends towards two core nodes, so that two independent chains of arithmetic run side by side. A
/// window around the core can be solved again for right-hand sides that differ only inside it, at the cost of the
/// window: what contacts need. With p, q the two nodes eliminated just before i (i-1, i-2 from the left; i+1, i+2 from
/// the right):
///   F_i = A_ip - A_iq H_p,  H_i = S_p^-1 F_i^T,  S_i = A_ii - A_iq^2 S_q^-1 - F_i H_i,
///   z_i = S_i^-1 (r_i - F_i z_p - A_iq z_q).
/// S is made exactly symmetric at every step: a skew rounding error would double from node to node.
/// Since A_iq is a multiple of the identity a node costs about ninety multiply-adds. Real time: no allocation after
/// resize(); O(n). @pre A positive definite.
class BandSolver {
 public:
  void resize(int n);
  [[nodiscard]] int nodes() const noexcept { return n_; }

  std::vector<Mat> diagonal, couple;  ///< n and n - 1 blocks (sized n); factor() changes them inside the window
  std::vector<double> skip;           ///< n - 2 scalars (sized n)
  std::vector<Vec> rhs;               ///< n right-hand sides; as diagonal

  /// Factorises, and eliminates `rhs`. @param core  core nodes are core and core + 1. @pre 0 <= core < n - 1.
  void factor(int core) noexcept;

  /// out[first .. last] = (A^-1 rhs)[first .. last], complete to the ends by first = 0, last = n - 1.
  /// @param extra  added to rhs, zero outside the window: read on [first, last]; may be null.
  /// @pre first <= core, core + 1 <= last. @param base false: the answer to `extra` alone.
  void solve(int first, int last, const Vec* extra, Vec* out, bool base) noexcept;

  /// After solve() with base: completes `v` outside [first, last].
  void solve_outside(int first, int last, Vec* v) const noexcept;

 private:
  friend class BandColumns;
  int n_ = 0, core_ = 0;
  std::vector<Mat> f_, h_, s_inverse_;  // F_i, H_i, S_i^-1
  std::vector<Vec> z_;                  // eliminated right-hand side
  std::vector<Vec> w_;                  // scratch of solve()
  Mat link_f_, link_;                   // F and H of node core + 1 towards the chain on its right
};

}  // namespace ligature::physics::rod
