#pragma once
// Random numbers that are the same with every compiler, standard library and processor. Output of std::mt19937 is fixed
// by the C++ standard, that of the standard distributions is not.

#include <array>
#include <cmath>
#include <cstdint>
#include <random>

namespace ligature::scene {

/// Uniform in [0, 1), with 53 random bits from two draws.
inline double share(std::mt19937& random) noexcept {
  const std::uint64_t low = random(), high = random();
  return static_cast<double>((high << 32 | low) >> 11) * 0x1p-53;
}

/// Uniform in [low, high).
inline double between(std::mt19937& random, double low, double high) noexcept {
  return std::fma(high - low, share(random), low);
}

/// Three independent numbers, each approximately normal with mean 0 and variance 1, magnitude at most 6: sums of twelve
/// uniform numbers, which need no function of libm.
inline std::array<double, 3> normals(std::mt19937& random) noexcept {
  std::array<double, 3> sums{-6.0, -6.0, -6.0};
  for (auto& sum : sums)
    for (int i = 0; i < 12; ++i) sum += share(random);
  return sums;
}

}  // namespace ligature::scene
