// Random and optimised attacks on the energy account of a hand must keep within the bounds of docs/passivity.md.
// passivity_study runs many more of them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>

#include "tests/unit/control/passivity_hands.hpp"

namespace ligature::control {
namespace {

void expect_within(const Port& port) {
  EXPECT_LE(port.bounds.above_J, kExact_J) << "the account above the work";
  EXPECT_LE(port.bounds.below_J, kExact_J) << "more given than the account had";
  EXPECT_LE(port.bounds.work_below_J, kExact_J) << "the true work";
  EXPECT_LE(port.bounds.above_ceiling_J, kExact_J) << "the term beyond";
}

struct Case {
  double wildness, count_m;
  bool loses;
};
constexpr std::array<Case, 6> kCases{
    {{1.0, 0.0, false}, {1.0, 5e-5, false}, {0.4, 0.0, true}, {1.0, 0.0, true}, {0.4, 5e-5, true}, {1.0, 5e-5, true}}};

TEST(PassivityBounds, HoldForEveryDraw) {
  test::Random random(61);
  for (const Case& c : kCases) {
    double lowest_J = 0.0, beyond_J = 0.0;
    for (int k = 0; k < 60; ++k) {
      const Port port = Attacker::drawn(random, c.wildness, c.count_m, c.loses).run(400);
      expect_within(port);
      lowest_J = std::min(lowest_J, port.lowest_work_J), beyond_J = std::max(beyond_J, port.bounds.most_beyond_J);
      if (!c.loses && c.count_m == 0.0) {
        EXPECT_GE(port.lowest_work_J, -Passivity::kFloor_J);
      }
      if (!c.loses) {
        EXPECT_EQ(port.bounds.most_beyond_J, 0.0);
      }
    }
    std::printf("%.1f of the wildest hand%s%s: true work from %.2e J, beyond up to %.2e J\n", c.wildness,
                c.count_m > 0.0 ? ", counts" : "", c.loses ? ", losses" : "", lowest_J, beyond_J);
  }
}

/// Each attack is optimised towards breaking one bound; every step is checked.
TEST(PassivityBounds, HoldForHandsThatClimb) {
  test::Random random(62);
  for (const Case& c : kCases) {
    for (int goal = 0; goal < 3; ++goal) {
      const Attacker first = Attacker::drawn(random, c.wildness, c.count_m, c.loses);
      (void)climb(first, 40, 200, random, [&](const Port& port) {
        expect_within(port);
        return goal == 0 ? port.bounds.above_J : goal == 1 ? port.bounds.below_J : -port.lowest_work_J;
      });
    }
  }
}

/// Between two samples the account assumes uniform motion. The samples here are two periods T apart, and a force of 0.3
/// N acts in the second period only. A hand that waits and then follows the force with acceleration a gets 0.3 N a T^2
/// / 2 more than is debited. No hand of at most this acceleration can get more.
TEST(PassivityBounds, WhatNobodySawIsWorthHalfAStepTimesTheAcceleration) {
  const double a = plain().hand_acceleration_m_per_s2;
  const auto excess_J = [&](double share) {
    Passivity p(plain(), kT_s, false, 0.0);
    const auto sample = [](double x_m, double made_N) {
      PortSample s{{x_m, 0, 0}, Vec3(x_m, 0, 0), 0.0, Vec3(1, 1, 1), {}, {}};
      s.acted.torque_Nm = Vec3(made_N, 0, 0);
      return s;
    };
    p.begin(0), p.observe(0, sample(0.0, 0.0)), p.sent(0, Vec3::Zero(), Vec3::Zero());
    p.begin(1), p.sent(1, Vec3(0.3, 0, 0), Vec3(0.3, 0, 0));
    p.begin(2), p.sent(2, Vec3(0.3, 0, 0), Vec3(0.3, 0, 0));
    p.begin(3);
    // Motion in period 1 to 2 and in period 2 to 3.
    const double d1 = 1e-5, d2 = d1 + share * a * kT_s * kT_s, start_m = 2e-5;
    Passivity q = p;
    q.observe(1, sample(start_m, 0.0));
    q.observe(3, sample(start_m + d1 + d2, 0.3));
    return q.energy_J() + 0.3 * d2;  // account minus true work
  };
  EXPECT_NEAR(excess_J(1.0), 0.3 * a * kT_s * kT_s / 2, 1e-12);
  EXPECT_NEAR(excess_J(-0.1), -0.03 * a * kT_s * kT_s / 2, 1e-12);
}

}  // namespace
}  // namespace ligature::control
