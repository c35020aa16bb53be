// The table of contact couplings (velocity of contact a per impulse on contact b) must be symmetric: one half is
// computed, the other half mirrored. The table must stay correct when two contacts exchange places.

#include "firmware/physics/rod/solve/contact_couplings.hpp"

#include <gtest/gtest.h>

#include <array>
#include <numeric>
#include <utility>
#include <vector>

namespace ligature::physics::rod {
namespace {

constexpr std::size_t kMost = 24;

// A distinct value for entry (i, j) of the block of contacts a, b; symmetric under exchange of both index pairs.
float number(std::size_t a, std::size_t b, std::size_t i, std::size_t j) {
  if (a < b || (a == b && i > j)) return number(b, a, j, i);
  return static_cast<float>(1000 * a + 10 * b + 3 * i + j) + 0.5F;
}

std::array<Four, 3> columns(std::size_t a, std::size_t b) {
  std::array<Four, 3> w{};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) w[i][static_cast<int>(j)] = number(a, b, i, j);
  }
  return w;
}

void expect(const Couplings& table, const std::vector<std::size_t>& who) {
  for (std::size_t a = 0; a < who.size(); ++a) {
    for (std::size_t b = 0; b < who.size(); ++b) {
      const float* const block = table.block(a, b / 8 * 8);
      for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 3; ++j)
          ASSERT_EQ(block[(3 * i + j) * 8 + b % 8], number(who[a], who[b], i, j)) << a << ' ' << b << ' ' << i << j;
      }
    }
  }
}

TEST(Couplings, HaveBothHalvesWhateverCameWhen) {
  Couplings table;
  table.reserve(kMost);
  std::vector<std::size_t> who;
  for (const std::size_t end : {3UL, 8UL, 9UL, 21UL, 24UL}) {
    const std::size_t from = who.size();
    for (std::size_t a = from; a < end; ++a) {
      who.push_back(a);
      for (std::size_t b = 0; b <= a; ++b) table.put(a, b, columns(a, b));
    }
    table.mirror(from, end);
    expect(table, who);
  }
}

TEST(Couplings, AreExchanged) {
  Couplings table;
  table.reserve(kMost);
  std::vector<std::size_t> who(19);
  std::iota(who.begin(), who.end(), 0UL);
  for (std::size_t a = 0; a < who.size(); ++a) {
    for (std::size_t b = 0; b <= a; ++b) table.put(a, b, columns(a, b));
  }
  table.mirror(0, who.size());
  for (const auto& [a, b] : {std::pair(0UL, 18UL), std::pair(3UL, 5UL), std::pair(7UL, 8UL), std::pair(18UL, 0UL)}) {
    table.exchange(a, b, who.size());
    std::swap(who[a], who[b]);
    expect(table, who);
  }
}

}  // namespace
}  // namespace ligature::physics::rod
