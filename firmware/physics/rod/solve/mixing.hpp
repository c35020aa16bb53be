#pragma once
// Anderson mixing: accelerates a slowly converging fixed-point iteration at the cost of a few dot products.

#include <array>
#include <vector>

#include "firmware/physics/rod/vec.hpp"

namespace ligature::physics::rod {

/// Solves p = G(p) by Anderson mixing [Anderson 1965]. After each evaluation p+ = G(p), with the residual r = p+ - p,
/// the next argument is the combination of the last few p+ that minimises the combined residual:
///   theta = argmin |r - sum theta_j dr_j|^2,   p = p+ - sum theta_j dp_j
/// dr_j, dp_j: changes of r and p+ from one evaluation to the next. For a linear G this is equivalent to GMRES [Walker
/// & Ni 2011]. G contains projections onto friction cones, so the combination can be worse than p+: the caller compares
/// the two, and calls restart() if it is. Impulses may be appended between evaluations; their past values count as
/// zero. Dot products of the changes are kept, so an evaluation costs eight of them. No allocation after reserve().
class Mixing {
 public:
  static constexpr int kDepth = 4;

  void reserve(std::size_t impulses) { past_.resize(impulses); }
  void restart() noexcept { held_ = next_ = 0, primed_ = false; }

  /// @param p in: p+, the newest evaluation; out: the next argument. @param r residual p+ - p. @return false if there
  /// are no earlier evaluations to combine with; then p is unchanged.
  bool step(Vec* p, const Vec* r, std::size_t impulses) noexcept;

 private:
  struct Past {
    std::array<Vec, kDepth> dr, dp;  // ring buffers; the newest entry is the one before next_
    Vec r, p;                        // of the last evaluation
  };
  void measure(const Vec* p, const Vec* r, std::size_t impulses, std::size_t slot,
               std::array<double, kDepth>& theta) noexcept;

  std::vector<Past> past_;
  std::array<std::array<double, kDepth>, kDepth> products_{};  // dr_j . dr_k
  std::size_t known_ = 0;                                      // impulses with an initialised entry in past_
  int next_ = 0, held_ = 0;
  bool primed_ = false;
};

}  // namespace ligature::physics::rod
