// Random numbers of programs: the values follow from the generator's bits alone.
#include "protocol/scene/random.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "tests/support/random.hpp"

namespace ligature::scene {
namespace {

/// Gives these numbers one after the other.
struct Given {
  std::vector<std::uint32_t> bits;
  std::size_t next = 0;
  std::uint32_t operator()() { return bits.at(next++); }
};

double share_of(std::uint32_t first, std::uint32_t second) {
  Given random{{first, second}};
  return share(random);
}

TEST(Random, AShareIsBothDrawsOver2To64) {
  constexpr auto kMost = std::numeric_limits<std::uint32_t>::max();
  EXPECT_EQ(share_of(0, 0), 0.0);
  EXPECT_EQ(share_of(0, 0x8000'0000), 0.5);
  EXPECT_EQ(share_of(0x8000'0000, 0), 0x1p-33);
  EXPECT_EQ(share_of(kMost, kMost), 1.0 - 0x1p-53) << "never 1";
}

TEST(Random, BetweenMapsTheShareToTheInterval) {
  Given random{{0, 0, 0, 0x8000'0000, 0, 0x4000'0000}};
  EXPECT_EQ(between(random, -3.0, 5.0), -3.0);
  EXPECT_EQ(between(random, -3.0, 5.0), 1.0);
  EXPECT_EQ(between(random, -3.0, 5.0), -1.0);
}

TEST(Random, NormalsHaveMeanZeroAndVarianceOne) {
  test::Random source(11);
  auto random = [&source] { return static_cast<std::uint32_t>(source() >> 32U); };
  constexpr int kDraws = 20'000;
  double sum = 0.0, squares = 0.0, products = 0.0;
  for (int i = 0; i < kDraws; ++i) {
    const auto [x, y, z] = normals(random);
    sum += x + y + z;
    squares += x * x + y * y + z * z;
    products += x * y + y * z + z * x;
  }
  const double n = 3.0 * kDraws;  // standard errors of the three means: at most 1.5/sqrt(n); bounds of six of them
  EXPECT_NEAR(sum / n, 0.0, 6.0 / std::sqrt(n));
  EXPECT_NEAR(squares / n, 1.0, 9.0 / std::sqrt(n));
  EXPECT_NEAR(products / n, 0.0, 6.0 / std::sqrt(n));
}

}  // namespace
}  // namespace ligature::scene
