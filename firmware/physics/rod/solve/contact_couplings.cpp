#include "firmware/physics/rod/solve/contact_couplings.hpp"

#include <algorithm>
#include <utility>

namespace ligature::physics::rod {
namespace {

// Transposes an 8 x 8 block. Its rows are `stride` numbers apart in `from`, and `to_stride` numbers apart in `to`.
inline void transpose(const float* from, std::size_t stride, float* to, std::size_t to_stride) noexcept {
  Eight row[8], pair[8];
  for (std::size_t k = 0; k < 8; ++k) row[k] = load_as<Eight>(from + k * stride);
  for (std::size_t k = 0; k < 8; k += 2) {
    pair[k] = __builtin_shufflevector(row[k], row[k + 1], 0, 8, 2, 10, 4, 12, 6, 14);
    pair[k + 1] = __builtin_shufflevector(row[k], row[k + 1], 1, 9, 3, 11, 5, 13, 7, 15);
  }
  for (const std::size_t k : {0, 1, 4, 5}) {
    row[k] = __builtin_shufflevector(pair[k], pair[k + 2], 0, 1, 8, 9, 4, 5, 12, 13);
    row[k + 2] = __builtin_shufflevector(pair[k], pair[k + 2], 2, 3, 10, 11, 6, 7, 14, 15);
  }
  for (std::size_t k = 0; k < 4; ++k) {
    store_as(to + k * to_stride, __builtin_shufflevector(row[k], row[k + 4], 0, 1, 2, 3, 8, 9, 10, 11));
    store_as(to + (k + 4) * to_stride, __builtin_shufflevector(row[k], row[k + 4], 4, 5, 6, 7, 12, 13, 14, 15));
  }
}

}  // namespace

// Sets W_ba = W_ab^T for the eight contacts from a on and the eight contacts from b on, b < a. Entries beyond the last
// contact are copied too, but never read.
void Couplings::mirror_block(std::size_t a, std::size_t b) noexcept {
  const float* const from = block(a, b);
  float* const to = w_.data() + b * stride_ + a * 9;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j)
      transpose(from + (3 * i + j) * kLanes, stride_, to + (3 * j + i) * kLanes, stride_);
  }
}

// W_ba = W_ab^T among the contacts a to end - 1.
void Couplings::mirror_diagonal(std::size_t a, std::size_t end) noexcept {
  for (std::size_t k = a + 1; k < end; ++k) {
    const float* const from = w_.data() + k * stride_ + a * 9;
    for (std::size_t b = a; b < k; ++b) {
      float* const to = w_.data() + b * stride_ + a * 9 + (k - a);
      for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 3; ++j) to[(3 * j + i) * kLanes] = from[(3 * i + j) * kLanes + (b - a)];
      }
    }
  }
}

void Couplings::mirror(std::size_t from, std::size_t end) noexcept {
  for (std::size_t a = from / kLanes * kLanes; a < end; a += kLanes) {
    for (std::size_t b = 0; b < a; b += kLanes) mirror_block(a, b);
    mirror_diagonal(a, std::min(a + kLanes, end));
  }
}

void Couplings::exchange(std::size_t a, std::size_t b, std::size_t count) noexcept {
  float* const w = w_.data();
  std::swap_ranges(w + a * stride_, w + a * stride_ + (count + kLanes - 1) / kLanes * kBlock, w + b * stride_);
  float *x = w + a / kLanes * kBlock + a % kLanes, *y = w + b / kLanes * kBlock + b % kLanes;
  for (std::size_t k = 0; k < count; ++k, x += stride_, y += stride_) {
    for (std::size_t m = 0; m < kBlock; m += kLanes) std::swap(x[m], y[m]);
  }
}

}  // namespace ligature::physics::rod
