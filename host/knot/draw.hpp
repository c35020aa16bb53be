#pragma once
#include <cstdint>

namespace ligature::knot {

/// Random numbers that are the same everywhere for the same seed: SplitMix64, and neither the library's distributions
/// nor libm. A knot is named alike by every build.
class Draw {
 public:
  explicit Draw(std::uint64_t seed) noexcept : state_(seed) {}

  /// From [0, 1).
  double share() noexcept {
    std::uint64_t z = (state_ += 0x9E3779B97F4A7C15ULL);
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ULL;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBULL;
    return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-53;
  }
  /// Bell-shaped, mean 0, variance 1: the sum of twelve shares.
  double bell() noexcept {
    double sum = -6.0;
    for (int i = 0; i < 12; ++i) sum += share();
    return sum;
  }

 private:
  std::uint64_t state_;
};

}  // namespace ligature::knot
