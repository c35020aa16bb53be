#pragma once
// Solver for the linear system of one substep. Its matrix is block pentadiagonal and symmetric positive definite, and
// is factorised from both ends inwards.

#include <cstddef>
#include <vector>

#include "firmware/physics/rod/solve/two.hpp"
#include "firmware/physics/rod/vec.hpp"

namespace ligature::physics::rod {

/// Solves A v = r for n nodes, where A has the 3 x 3 blocks
///   A(i, i) = diagonal[i],  A(i, i+1) = couple[i] (symmetric),  A(i, i+2) = skip[i] I.
/// Method: block LDL^T from both ends towards two core nodes; the two chains of nodes are computed in the two lanes of
/// a register. Contacts need solutions for right-hand sides that differ only inside a window around the core: each
/// further solution in the window costs O(window). With p, q: the nodes eliminated just before i (i-1, i-2 from the
/// left; i+1, i+2 from the right):
///   F_i = A_ip - A_iq H_p,  H_i = S_p^-1 F_i^T,  S_i = A_ii - A_iq^2 S_q^-1 - F_i H_i,
///   y_i = r_i - H_i^T y_p - A_iq z_q,  z_i = S_i^-1 y_i.
/// Each node depends on the one before, so latency dominates the time. S_p^-1 is therefore used as adjugate /
/// determinant: the division runs in parallel with F_i adj(S_p) F_i^T, and y needs one dependent product per node. S is
/// stored as a triangle, because an unsymmetric rounding error would double from node to node. A_iq is a multiple of
/// the identity, so a node costs about 120 multiply-adds. No allocation after resize(); O(max(core, n - core)).
/// @pre A positive definite.
class BandSolver {
 public:
  void resize(int n);
  [[nodiscard]] int nodes() const noexcept { return n_; }

  std::vector<Mat> diagonal, couple;  ///< n and n - 1 blocks (sized n); of each, the lower triangle is read
  std::vector<double> skip;           ///< n - 2 scalars (sized n)
  std::vector<Vec> rhs;               ///< n right-hand sides

  /// Factorises A and eliminates `rhs`, towards the core nodes core and core + 1. @pre 0 <= core < n - 1.
  void factor(int core) noexcept;

  /// Computes out = A^-1 (rhs + extra) for the nodes first to last; O(last - first).
  /// @param extra  read on [first, last], zero elsewhere; may be null
  /// @param base  false: out = A^-1 extra, without rhs
  /// @pre first <= core, core + 1 <= last
  void solve(int first, int last, const Vec* extra, Vec* out, bool base) noexcept;

  /// Call after solve() with base = true: computes the rest of `v`, outside [first, last].
  void solve_outside(int first, int last, Vec* v) const noexcept;

 private:
  friend class BandColumns;
  /// Factors of the two nodes that are k + 1 nodes left and right of the core.
  struct Step {
    TwoMats h;          // H_i of the formulas above, for the two nodes i
    TwoSyms s_inverse;  // S^-1
    Twos z;             // z_i: right-hand sides after elimination
    Two skip;           // coupling to the nodes two further in
  };
  /// Entries A_ii, A_ip, A_iq, r_i (class comment) for the two nodes i of a step; 1, 0, 0, 0 in a lane without a node.
  struct Rows {
    TwoSyms diagonal, couple;
    Two skip;
    Twos rhs;
  };
  /// S^-1 of the previous step, in two factors.
  struct Pivot {
    TwoSyms adjugate{};
    Two scale{};  // 1 / det(S)
  };
  [[nodiscard]] Rows rows(std::ptrdiff_t k) const noexcept;
  [[nodiscard]] std::ptrdiff_t steps() const noexcept;
  static Pivot pivot_of(const TwoSyms& s) noexcept;
  static TwoSyms eliminate(const Rows& a, const Step& p, Step& q, const Pivot& pivot, TwoMats& h, Twos& y) noexcept;
  /// Back substitution. @return the solution at step k, from the eliminated right-hand side w and the solutions at step
  /// k - 1 (`one`) and step k - 2 (`two`).
  [[nodiscard]] Twos substitute(std::ptrdiff_t k, const Twos& w, const Twos& one, const Twos& two) const noexcept {
    const Step& s = steps_[k];
    const TwoMats& h = k > 0 ? steps_[static_cast<std::size_t>(k) - 1].h : core_h_;
    return less(w - s.skip * (s.s_inverse * two), h, one);
  }

  int n_ = 0, core_ = 0;
  std::vector<Step> steps_;
  TwoMats core_h_;              // H_i of the two core nodes, from the elimination on their own side
  Vec core_z_, next_z_;         // z of the core nodes
  Mat core_inverse_, between_;  // S^-1 of node core, and A(core + 1, core) once the chains are eliminated
  Mat next_inverse_, next_h_;   // S^-1 and H of node core + 1, the last
  std::vector<Twos> w_;         // scratch of solve()
};

}  // namespace ligature::physics::rod
