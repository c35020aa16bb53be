#pragma once
// Anderson mixing: makes a slowly converging fixed point converge fast, at the cost of a few dot products.

#include <array>
#include <vector>

#include "firmware/physics/rod/vec.hpp"

namespace ligature::physics::rod {

/// Fixed point p = G(p). After each evaluation p+ = G(p), r = p+ - p, the
/// next argument is the mixture of the last few p+ whose residuals cancel best:
///   theta = argmin |r - sum theta_j dr_j|^2,   p = p+ - sum theta_j dp_j   [Anderson 1965]
/// with dr_j, dp_j the changes of r and p+ from one evaluation to the next,
/// which on a linear map does what GMRES does [Walker & Ni 2011]. With cones in G a mixture can be far off: the
/// caller compares it with p+ and restarts when it is worse. Impulses may be added at the end from one evaluation to
/// the next; they count as zero until then. Products of the changes are kept, so an evaluation costs eight dot
/// products. No allocation after reserve().
class Mixing {
 public:
  static constexpr int kDepth = 4;

  void reserve(std::size_t impulses) { past_.resize(impulses); }
  void restart() noexcept { held_ = next_ = 0, primed_ = false; }

  /// @param p  in: p+; out: what to try next.  @param r p+ - p.  @return false when there is no past to mix with yet.
  bool step(Vec* p, const Vec* r, std::size_t impulses) noexcept;

 private:
  struct Past {
    std::array<Vec, kDepth> dr, dp;  // by slot; newest in the slot before next_
    Vec r, p;                        // of the last evaluation
  };
  void measure(const Vec* p, const Vec* r, std::size_t impulses, std::size_t slot,
               std::array<double, kDepth>& theta) noexcept;

  std::vector<Past> past_;
  std::array<std::array<double, kDepth>, kDepth> products_{};  // dr_j . dr_k
  std::size_t known_ = 0;                                      // impulses that have a past
  int next_ = 0, held_ = 0;
  bool primed_ = false;
};

}  // namespace ligature::physics::rod
