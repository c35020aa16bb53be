// Dense, the solver for small dense systems M x = b, reproduces known solutions.

#include "firmware/physics/rod/solve/dense.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/support/random.hpp"

namespace ligature::physics::rod {
namespace {

constexpr std::size_t kMostRows = 61;

/// Largest error of the solution of M x = b for a known x.
double error_of(Dense& dense, const std::vector<double>& m, std::size_t n, unsigned seed) {
  test::Random random(seed);
  const auto normal = [&] { return random.normal(); };
  std::vector<double> x(n);
  for (auto& value : x) value = normal();
  dense.resize(n);
  for (std::size_t i = 0; i < n; ++i) {
    float* const row = dense.row(i);
    std::fill(row, row + ((n + 8) & ~std::size_t{7}), 0.0F);
    double b = 0.0;
    for (std::size_t j = 0; j < n; ++j) row[j] = static_cast<float>(m[i * n + j]), b += m[i * n + j] * x[j];
    row[n] = static_cast<float>(b);
  }
  if (!dense.solve()) return 1e9;
  double worst = 0.0;
  for (std::size_t i = 0; i < n; ++i) worst = std::max(worst, std::abs(static_cast<double>(dense.x(i)) - x[i]));
  return worst;
}

// All sizes up to 61, as the solver treats remainders of four and eight columns separately.
TEST(Dense, SolvesWhatIsNearlySymmetric) {
  Dense dense;
  dense.reserve(kMostRows);
  for (std::size_t n = 1; n <= kMostRows; ++n) {
    test::Random random(static_cast<unsigned>(n));
    const auto normal = [&] { return random.normal(); };
    std::vector<double> a(n * n), m(n * n);
    for (auto& value : a) value = normal();
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = 0; j < n; ++j) {
        for (std::size_t k = 0; k < n; ++k) m[i * n + j] += a[i * n + k] * a[j * n + k] / static_cast<double>(n);
        m[i * n + j] += (i == j ? 1.0 : 0.0) + 0.1 * a[i * n + j] / std::sqrt(static_cast<double>(n));
      }
    }
    EXPECT_LT(error_of(dense, m, n, 7), 1e-4) << n;
  }
}

TEST(Dense, ExchangesRowsWhereAPivotVanishes) {  // a permutation matrix: every pivot is off the diagonal
  Dense dense;
  dense.reserve(kMostRows);
  for (const std::size_t n : {2UL, 5UL, 16UL, 33UL}) {
    std::vector<double> m(n * n);
    for (std::size_t i = 0; i < n; ++i) m[i * n + (i + n / 2) % n] = 2.0, m[i * n + (i + n / 3) % n] += 0.1;
    EXPECT_LT(error_of(dense, m, n, 3), 1e-4) << n;
  }
}

TEST(Dense, SaysThatThereIsNoAnswer) {
  Dense dense;
  dense.reserve(kMostRows);
  const std::size_t n = 9;
  EXPECT_EQ(error_of(dense, std::vector<double>(n * n, 0.0), n, 3), 1e9);
}

}  // namespace
}  // namespace ligature::physics::rod
