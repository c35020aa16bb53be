#pragma once
// The coupling matrix W of contacts, dense and symmetric: relative velocity at one contact per impulse at another.

#include <array>
#include <cstddef>

#include "firmware/physics/members.hpp"
#include "firmware/physics/rod/solve/floats.hpp"
#include "firmware/physics/rod/solve/node_velocities.hpp"

namespace ligature::physics::rod {

/// Coupling matrix W of up to `most` contacts: an impulse p_b at contact b changes the relative velocity at contact a
/// by W_ab p_b. Each pair has a 3 x 3 block, W_ba = W_ab^T; both triangles are stored. The row of contact a is stored
/// in groups of eight contacts b: for each i, j the eight numbers W_ab(i, j) are adjacent, at offset (3 i + j) x 8. So
/// vector loads read a row sequentially, which matters because the table exceeds the first-level cache.
class Couplings {
 public:
  static constexpr std::size_t kLanes = 8, kBlock = 9 * kLanes;

  void reserve(std::size_t most) { stride_ = (most + kLanes - 1) / kLanes * kBlock, w_.resize(most * stride_); }

  /// The numbers of contacts b to b + 7 in the row of contact a. @pre b is a multiple of eight.
  [[nodiscard]] const float* block(std::size_t a, std::size_t b) const noexcept {
    return w_.data() + a * stride_ + b * 9;
  }
  /// Stores W_ab, but only in the row of contact a. @param w w[j]: velocity per unit impulse along axis j. @pre b <= a.
  /// @see mirror
  void put(std::size_t a, std::size_t b, const std::array<Four, 3>& w) noexcept {
    float* const at = w_.data() + a * stride_ + b / kLanes * kBlock + b % kLanes;
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) at[(3 * i + j) * kLanes] = w[i][static_cast<int>(j)];
    }
  }
  /// Sets W_ba = W_ab^T, after put() of the rows from <= a < end. About 6 (end^2 - from^2) instructions.
  void mirror(std::size_t from, std::size_t end) noexcept;
  /// Exchanges contacts a and b in a table of `count` contacts.
  void exchange(std::size_t a, std::size_t b, std::size_t count) noexcept;
  LIGATURE_MEMBERS(Couplings, stride, w)

 private:
  void mirror_block(std::size_t a, std::size_t b) noexcept;
  void mirror_diagonal(std::size_t a, std::size_t end) noexcept;

  std::size_t stride_ = 0;  // numbers per row
  Floats w_;
};

}  // namespace ligature::physics::rod
