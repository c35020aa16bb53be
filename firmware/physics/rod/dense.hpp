#pragma once
// A small dense system of equations in single precision.

#include <cstddef>
#include <vector>

#include "firmware/physics/rod/floats.hpp"
#include "firmware/physics/rod/work.hpp"

namespace ligature::physics::rod {

/// M x = b. Elimination makes a unit matrix of eight columns and rows at a time, takes them from the rows below, and
/// exchanges rows only where a pivot has shrunk to 1e-4 of what it was: nearly all of M is symmetric and positive.
/// O(n^3 / 15) instructions; relative accuracy 1e-6 times the condition of M.
class Dense {
 public:
  void reserve(std::size_t most);
  void resize(std::size_t unknowns) noexcept { n_ = unknowns, stride_ = (unknowns + 8) & ~std::size_t{7}; }

  /// Row i of M; b_i behind it, and zeros up to the end of the row, a multiple of eight. Up to eight more numbers may
  /// be written behind what is asked for, if rows are written in order.
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

  Floats m_, x_, first_;             // the diagonal before elimination
  std::vector<std::size_t> panels_;  // rows in which they begin
  std::size_t n_ = 0, stride_ = 8;
};

}  // namespace ligature::physics::rod
