#pragma once
// Random numbers that are the same with every compiler, standard library and processor. Output of std::mt19937 is fixed
// by the C++ standard, that of the standard distributions is not. `random` is a generator of 32 bits, like that one.

#include <array>
#include <cmath>
#include <cstdint>

namespace ligature::scene {

/// Uniform in [0, 1), with 53 random bits from two draws.
template <class Generator>
double share(Generator& random) {
  const std::uint64_t low = random(), high = random();
  return static_cast<double>((high << 32 | low) >> 11) * 0x1p-53;
}

/// Uniform in [low, high).
template <class Generator>
double between(Generator& random, double low, double high) {
  return std::fma(high - low, share(random), low);
}

/// Three independent numbers, each approximately normal with mean 0 and variance 1, magnitude at most 6: sums of twelve
/// uniform numbers, which need no function of libm.
template <class Generator>
std::array<double, 3> normals(Generator& random) {
  std::array<double, 3> sums{-6.0, -6.0, -6.0};
  for (auto& sum : sums)
    for (int i = 0; i < 12; ++i) sum += share(random);
  return sums;
}

}  // namespace ligature::scene
