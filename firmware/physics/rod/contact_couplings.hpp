#pragma once
// What impulses on contacts do to each other's velocities: a dense symmetric table.

#include <array>
#include <cstddef>

#include "firmware/physics/rod/floats.hpp"
#include "firmware/physics/rod/swept.hpp"

namespace ligature::physics::rod {

/// W of up to `most` contacts: u_a += W_ab p_b, 3 x 3 numbers a pair, W_ba = W_ab^T. Kept whole, by contact a in blocks
/// of eight others: number 3 i + j of a block holds W_ab's i, j for its eight b. So a row is read in order, and a
/// contact's part in another's row lies on five lines of memory; the table does not fit the first cache.
class Couplings {
 public:
  static constexpr std::size_t kLanes = 8, kBlock = 9 * kLanes;

  void reserve(std::size_t most) { stride_ = (most + kLanes - 1) / kLanes * kBlock, w_.resize(most * stride_); }

  /// Numbers of the block that begins with contact b, in the row of a. @pre b a multiple of eight.
  [[nodiscard]] const float* block(std::size_t a, std::size_t b) const noexcept {
    return w_.data() + a * stride_ + b * 9;
  }
  /// W_ab, by columns that answer to an impulse along x, y, z; one side only. @pre b <= a. @see mirror
  void put(std::size_t a, std::size_t b, const std::array<Four, 3>& w) noexcept {
    float* const at = w_.data() + a * stride_ + b / kLanes * kBlock + b % kLanes;
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) at[(3 * i + j) * kLanes] = w[i][static_cast<int>(j)];
    }
  }
  /// Contacts `from` to `end` were put: W_ba of those. O(end^2 - from^2) x 6 instructions.
  void mirror(std::size_t from, std::size_t end) noexcept;
  /// Two of `count` contacts change places.
  void exchange(std::size_t a, std::size_t b, std::size_t count) noexcept;

 private:
  void mirror_block(std::size_t a, std::size_t b) noexcept;
  void mirror_diagonal(std::size_t a, std::size_t end) noexcept;

  std::size_t stride_ = 0;  // of a contact
  Floats w_;
};

}  // namespace ligature::physics::rod
