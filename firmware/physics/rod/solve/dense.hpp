#pragma once
// Solver for a small dense linear system in single precision.

#include <cstddef>
#include <vector>

#include "firmware/physics/rod/solve/floats.hpp"
#include "firmware/physics/rod/work.hpp"

namespace ligature::physics::rod {

/// Solves M x = b by block Gauss elimination: up to eight columns at a time (two panels of four) are reduced to a unit
/// matrix and eliminated from the rows below. Rows are exchanged only where a pivot has shrunk to 1e-4 of its value;
/// this is rare, because nearly all of M is symmetric positive definite. About n^3 / 15 instructions; relative accuracy
/// 1e-6 x cond(M).
class Dense {
 public:
  void reserve(std::size_t most);
  void resize(std::size_t unknowns) noexcept { n_ = unknowns, stride_ = (unknowns + 8) & ~std::size_t{7}; }

  /// Memory of row i: the row of M, then b_i, then zeros up to a multiple of eight numbers. If rows are written in
  /// order, up to eight numbers may be written past the end of a row.
  [[nodiscard]] float* row(std::size_t i) noexcept { return m_.data() + i * stride_; }

  /// @return false when M is singular, or the time was over first. M is lost.
  [[nodiscard]] bool solve(TickTime& time = TickTime::endless()) noexcept;
  [[nodiscard]] float x(std::size_t i) const noexcept { return x_.data()[i]; }

 private:
  [[nodiscard]] bool pivot(std::size_t k) noexcept;
  template <std::size_t Before>
  [[nodiscard]] bool join(std::size_t k) noexcept;
  [[nodiscard]] std::size_t panel(std::size_t k) noexcept;
  [[nodiscard]] std::size_t two_panels(std::size_t k) noexcept;
  void clear_below(std::size_t k, std::size_t pivots, std::size_t first) noexcept;
  void substitute() noexcept;

  Floats m_, x_, first_;             // first_: absolute values of the diagonal before elimination
  std::vector<std::size_t> panels_;  // first row of each panel
  std::size_t n_ = 0, stride_ = 8;
};

}  // namespace ligature::physics::rod
