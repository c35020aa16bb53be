// Hanging threads: catenary, elastic string.

#include <gtest/gtest.h>

#include <cmath>

#include "tests/unit/rod/reference.hpp"
#include "tests/unit/rod/rods.hpp"

namespace ligature::test {
namespace {

TEST(Catenary, SagAndEndTension) {  // closed form; bending is 1e-7 w L^3, tension EA strain of the end segment
  for (const int n : {50, 200}) {
    for (const auto& row : read_table("02_catenary_inextensible.csv").rows) {
      const double span = number(row, "span_over_S");
      if (span < 0.35 || span > 0.95) continue;
      Material m = unit_rod();
      m.EI_N_m2 = 1e-7;
      m.EA_N = 1e5;
      m.drag_per_s = 4.0;
      Rod rod(m, steps_of(0.01), kBare, n);
      auto& x = rod.state().x;
      const double depth = 0.5 * std::sqrt(1.0 - span * span);
      for (std::size_t i = 0; i < x.size(); ++i) {  // a V to start from
        const double s = static_cast<double>(i) / (n - 1);
        x[i] = make(span * s, 0, -2.0 * depth * std::min(s, 1.0 - s));
      }
      rod.gravity = make(0, 0, -1);
      rod.support(0, x.front());
      rod.support(n - 1, x.back());
      rod.moved();
      ASSERT_TRUE(settle(rod, 1e-5, 20000)) << span;
      double lowest = 0.0;
      for (const auto& p : x) lowest = std::max(lowest, -p[2]);
      EXPECT_NEAR(lowest, number(row, "sag_over_S"), 2e-3) << span << " N = " << n;
      // The end segment hangs below half its own weight less than the support.
      const Vec end = rod.forces().edge[0];
      const double tension = norm(end + make(0, 0, -0.5 / (n - 1)));
      EXPECT_NEAR(tension / number(row, "Tend_over_wS"), 1.0, 5e-3) << span << " N = " << n;
    }
  }
}

TEST(HangingString, StretchesByItsWeightAndTheTipWeight) {  // closed form; lumped masses are exact to O(1 / N^2)
  for (const auto& row : read_table("02_hanging_elastic_string.csv").rows) {
    const double softness = number(row, "wL_over_EA"), weight = number(row, "tip_weight_over_wL");
    if (number(row, "s_over_L") < 1.0 || softness > 0.2) continue;
    const int n = 50;
    Material m = unit_rod();
    m.EI_N_m2 = 0.0;
    m.EA_N = 1.0 / softness;
    m.stretch_tau_s = 0.1;
    Rod rod(m, steps_of(0.02), kBare, n);
    for (std::size_t i = 0; i < n; ++i) rod.state().x[i] = make(0, 0, -rod.state().mesh.s[i]);
    rod.gravity = make(0, 0, -1);
    rod.support(0, make(0, 0, 0));
    rod.state().load[n - 1] = make(0, 0, -weight);
    rod.moved();
    ASSERT_TRUE(settle(rod, 1e-8, 20000));
    const double extension = -rod.state().x[n - 1][2] - 1.0, truth = number(row, "position_over_L") - 1.0;
    EXPECT_NEAR(extension / truth, 1.0, 5e-3) << softness << " " << weight;
  }
}

}  // namespace
}  // namespace ligature::test
