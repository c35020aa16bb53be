#pragma once
// Expects that random operators tie a knot.

#include <gtest/gtest.h>

#include <cstdint>
#include <cstdio>
#include <string>

#include "tests/support/random.hpp"

namespace ligature::test {

/// Expects a knot that is tied in at least 99 % of all runs. Draws `first` operators, or eight if one of these misses;
/// fails if four of the eight miss. For such a knot that happens less than once in a million draws.
/// @param tied ties with an operator's seed, and returns the type of the knot
template <class Tie>
void expect_tied(const std::string& type, std::uint64_t seed, Tie tied, int first = 3) {
  constexpr int kMostMisses = 3;
  Random random(seed);
  int misses = 0;
  for (int runs = 0; runs < (misses == 0 ? first : 8) && misses <= kMostMisses; ++runs) {
    const auto one = static_cast<std::uint32_t>(random());
    const std::string found = tied(one);
    misses += found != type;
    std::printf("operator of seed %u: %s\n", one, found.c_str());
  }
  EXPECT_LE(misses, kMostMisses) << "of eight: " << type;
}

}  // namespace ligature::test
