// Large deflection of a cantilever against the elastica: under a tip load and under its own weight.

#include <gtest/gtest.h>

#include "tests/unit/rod/reference.hpp"
#include "tests/unit/rod/rods.hpp"

namespace ligature::test {
namespace {

// Clamped at the origin along +x, loaded along -y in the rod's own units; the tip's place is compared.
Vec tip(int n, double tip_load, double weight) {
  Material m = unit_rod();
  m.drag_per_s = 5.0;
  Rod rod(m, steps_of(0.02), kBare, n);
  rod.clamp(0, make(0, 0, 0), make(1, 0, 0));
  rod.state().load[static_cast<std::size_t>(n - 1)] = make(0, -tip_load, 0);
  rod.gravity = make(0, -weight, 0);
  EXPECT_TRUE(settle(rod, 1e-6, 5000));
  return rod.state().x[static_cast<std::size_t>(n - 1)];
}

void compare(const char* table, const char* column, bool heavy, int n, double tolerance) {
  for (const auto& row : read_table(table).rows) {
    const double load = number(row, column);
    if (load > 20.0) continue;
    const Vec p = heavy ? tip(n, 0.0, load) : tip(n, load, 0.0);
    EXPECT_NEAR(p[0], number(row, "tip_x_over_L"), tolerance) << table << " at " << load << ", N = " << n;
    EXPECT_NEAR(-p[1], number(row, "tip_y_over_L"), tolerance) << table << " at " << load << ", N = " << n;
  }
}

TEST(Cantilever, FollowsTheElasticaUnderATipLoad) {  // elliptic integrals, closed form; second order in 1 / N
  compare("01_elastica_tip_load.csv", "PL2_over_EI", false, 50, 5e-3);
  compare("01_elastica_tip_load.csv", "PL2_over_EI", false, 200, 1e-3);
}

TEST(Cantilever, FollowsTheHeavyElastica) {  // shooting, 1e-9
  compare("01_heavy_elastica.csv", "wL3_over_EI", true, 50, 5e-3);
  compare("01_heavy_elastica.csv", "wL3_over_EI", true, 200, 1e-3);
}

TEST(Cantilever, ConvergesAtSecondOrder) {  // P L^2 / EI = 10; the linear theory has no part in it
  const double x = 0.445004402246;
  const double e25 = std::abs(tip(25, 10.0, 0.0)[0] - x), e50 = std::abs(tip(50, 10.0, 0.0)[0] - x);
  EXPECT_NEAR(std::log2(e25 / e50), 2.0, 0.3) << e25 << " " << e50;
}

}  // namespace
}  // namespace ligature::test
