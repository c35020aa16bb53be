#pragma once
// Anderson mixing: makes a slowly converging fixed point converge fast, at the cost of a few dot products.

#include <array>
#include <vector>

#include "firmware/physics/rod/vec.hpp"

namespace ligature::physics::rod {

/// Fixed point p = G(p). After each evaluation p+ = G(p), r = p+ - p, the
/// next argument is the mixture of the last few p+ whose residuals cancel best:
///   theta = argmin |r_k - sum theta_j (r_k - r_{k-j})|^2,   p = p+_k - sum theta_j (p+_k - p+_{k-j})   [Anderson 1965]
/// which on a linear map does what GMRES does [Walker & Ni 2011]. With cones in G a mixture can be far off: the
/// caller compares it with p+ and restarts when it is worse. No allocation after reserve().
class Mixing {
 public:
  static constexpr int kDepth = 4;

  void reserve(std::size_t impulses);
  void restart() noexcept { held_ = 0; }

  /// @param p  in: p+; out: what to try next.  @param r p+ - p.  @return false when there is no past to mix with yet.
  bool step(Vec* p, const Vec* r, std::size_t impulses) noexcept;

 private:
  struct Past {
    std::vector<Vec> p, r;
  };
  std::array<Past, kDepth + 1> past_;  // ring; newest at newest_
  int newest_ = 0, held_ = 0;
};

}  // namespace ligature::physics::rod
