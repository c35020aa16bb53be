#pragma once
// Anderson mixing: makes a slowly converging fixed point converge fast, at the cost of a few dot products.

#include <array>
#include <vector>

#include "firmware/physics/rod/vec.hpp"

namespace ligature::physics::rod {

/// Fixed point p = G(p) with a companion v that is an affine function of p. After each evaluation p+ = G(p), r = p+ - p, the
/// next argument is the mixture of the last few p+ whose residuals cancel best:
///   theta = argmin |r_k - sum theta_j (r_k - r_{k-j})|^2,   p = p+_k - sum theta_j (p+_k - p+_{k-j})   [Anderson 1965]
/// which on a linear map does what GMRES does [Walker & Ni 2011]. With cones in G it is an accelerator without a proof:
/// the caller ends with a plain evaluation, and a residual that grows forgets the past. No allocation after reserve().
class Mixing {
 public:
  static constexpr int kDepth = 4;

  void reserve(std::size_t impulses, std::size_t velocities);
  void restart() noexcept { held_ = 0, last2_ = 1e300; }

  /// @param p, v in: p+ and its v; out: what to try next.  @param r p+ - p.  Sizes at most those reserved.
  void step(Vec* p, const Vec* r, std::size_t impulses, Vec* v, std::size_t velocities) noexcept;

 private:
  struct Past {
    std::vector<Vec> p, r, v;
  };
  std::array<Past, kDepth + 1> past_;  // ring; newest at newest_
  int newest_ = 0, held_ = 0;
  double last2_ = 1e300;
};

}  // namespace ligature::physics::rod
