// Before a force is sent to a hand's motors (its port), the hand's energy account must cover what the force and the
// torques still in transit may deliver in the coming ticks. Also: energy that one hand's account lends to the other.
#include <gtest/gtest.h>

#include "firmware/control/passivity.hpp"
#include "tests/unit/control/plain_device.hpp"

namespace ligature::control {
namespace {

/// A port at rest at 0, sampled once.
Passivity resting(double credit_J) {
  Passivity p(plain(), kT_s, true, credit_J);
  p.observe(0, {});
  return p;
}

/// A port whose first torque message (RPDO) was lost `later` ticks ago. Meanwhile the hand moves along `axis` at 0.05
/// m/s, and a force of 0.3 N is on its way to the drives.
struct Lossy {
  Lossy(const Vec3& axis, double credit_J, int later) : passivity(plain(), kT_s, true, credit_J) {
    for (int n = 0; n <= later + 2; ++n) {
      const Vec3 at = n * kT_s * 0.05 * axis;
      PortSample sample{{at.x(), at.y(), at.z()}, at, 0.0, Vec3(1, 1, 1), 0.05 * axis, {}, Mat3::Identity()};
      sample.acted.torque_Nm = Vec3::Zero();
      passivity.begin(n);
      passivity.observe(n, sample);
      const Vec3 sends = n == 0 ? Vec3(1e-3 * axis) : n == later + 1 ? Vec3(0.3 * axis) : Vec3(Vec3::Zero());
      if (n <= later + 1) passivity.sent(n, sends, sends);
    }
    tick = later + 2;
  }
  /// The largest force in this direction that the account allows.
  [[nodiscard]] double most_N(const Vec3& along) const {
    double low = 0.0, high = 3.3;
    for (int i = 0; i < 50; ++i) {
      const double middle = 0.5 * (low + high);
      (passivity.allows(tick, middle * along) ? low : high) = middle;
    }
    return low;
  }
  Passivity passivity;
  std::int64_t tick = 0;
};

/// 5 N s/m at 0.1 m/s dissipate 5 x 0.1^2 x 1 ms.
TEST(Passivity, TellsTheEnergyThatItsDamperDissipates) {
  Passivity p = resting(0.0);
  (void)p.control(0, Vec3(0.4, 0, 0), Vec3(0.1, 0, 0), Vec3::Zero());
  ASSERT_GT(p.injected_N_s_per_m(), 0.0);
  EXPECT_NEAR(p.dissipated_J(), p.injected_N_s_per_m() * 0.1 * 0.1 * kT_s, 1e-12);
}

/// The account's reserve for torques in transit is the same for every axis and direction.
TEST(Passivity, NoAxisIsForeseenLessThanAnother) {
  const double first_N = Lossy(Vec3(1, 0, 0), 2e-4, 5).most_N(Vec3(1, 0, 0));
  ASSERT_GT(first_N, 0.01);
  ASSERT_LT(first_N, 3.0);
  for (const Vec3& axis : {Vec3(0, 1, 0), Vec3(0, 0, 1), Vec3(-1, 0, 0), Vec3(0, -1, 0), Vec3(0, 0, -1)})
    EXPECT_NEAR(Lossy(axis, 2e-4, 5).most_N(axis), first_N, 1e-9) << axis.transpose();
}

/// For ten seconds after a lost RPDO the account expects another loss, by which a force would act for two periods
/// instead of one. The account must cover the worst motion of a hand at rest: full acceleration along the force in the
/// period before the force acts and in the first period in which it acts, and 0.3 of the full acceleration in the
/// second.
TEST(Passivity, AForceThatMayActTwiceIsPaidForTwice) {
  const double a = plain().hand_acceleration_m_per_s2, credit_J = 3e-5;
  for (const int later : {2, 100, 9990}) {
    Passivity p(plain(), kT_s, true, credit_J);
    for (int n = 0; n <= later; ++n) {
      PortSample sample{};
      sample.lever_m = Vec3(1, 1, 1);
      sample.acted.torque_Nm = Vec3::Zero();
      p.begin(n);
      p.observe(n, sample);
      const Vec3 sends = n == 0 ? Vec3(1e-3, 0, 0) : Vec3(Vec3::Zero());
      if (n < later) p.sent(n, sends, sends);
    }
    double most_N = 0.0;
    for (double f = 1e-3; f < 0.5 && p.allows(later, Vec3(f, 0, 0)); f += 1e-3) most_N = f;
    EXPECT_GT(most_N, 0.05) << later;
    const double twice_J = most_N * a * kT_s * kT_s * (1.5 + 2.15), slight_J = 0.006 * a * kT_s * kT_s * 2.3;
    EXPECT_LE(twice_J, credit_J + Passivity::kFloor_J + slight_J) << later << " ticks later, " << most_N << " N";
  }
}

TEST(Passivity, APortThatIsShortGetsWhatItNeedsAndNoMore) {
  Passivity poor = resting(0.0), rich = resting(0.01);
  const Vec3 wish(0.4, 0, 0);
  ASSERT_FALSE(poor.allows(0, wish));
  Passivity::lend(0, poor, wish, rich, Vec3::Zero());
  EXPECT_TRUE(poor.allows(0, wish));
  EXPECT_FALSE(poor.allows(0, 1.2 * wish));
  EXPECT_DOUBLE_EQ(poor.energy_J() + rich.energy_J(), 0.01);
  EXPECT_DOUBLE_EQ(poor.received_J(), -rich.received_J());
  EXPECT_GT(poor.received_J(), 0.0);
}

TEST(Passivity, ALenderKeepsWhatItsOwnForceNeeds) {
  const Vec3 wish(0.4, 0, 0), much(3.3, 0, 0);
  Passivity poor = resting(0.0), rich = resting(0.001);
  ASSERT_TRUE(rich.allows(0, wish));
  Passivity::lend(0, poor, much, rich, wish);
  EXPECT_TRUE(rich.allows(0, wish));
  EXPECT_GT(poor.energy_J(), 0.0);
  Passivity other = resting(0.0), another = resting(0.0);  // both accounts are empty
  Passivity::lend(0, other, wish, another, wish);
  EXPECT_DOUBLE_EQ(other.received_J(), 0.0);
}

}  // namespace
}  // namespace ligature::control
