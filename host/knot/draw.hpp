#pragma once
#include <cstdint>

namespace ligature::knot {

/// Pseudo-random numbers (SplitMix64) that depend on the seed only. Neither the standard distributions nor libm is
/// used, because they differ between platforms: every build must give a thread the same knot name.
class Draw {
 public:
  explicit Draw(std::uint64_t seed) noexcept : state_(seed) {}

  /// Uniform in [0, 1).
  double share() noexcept {
    std::uint64_t z = (state_ += 0x9E3779B97F4A7C15ULL);
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ULL;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBULL;
    return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-53;
  }
  /// Approximately normal, mean 0, variance 1: the sum of twelve uniform numbers, less 6.
  double bell() noexcept {
    double sum = -6.0;
    for (int i = 0; i < 12; ++i) sum += share();
    return sum;
  }

 private:
  std::uint64_t state_;
};

}  // namespace ligature::knot
