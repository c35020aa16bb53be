// The controller limits the motors' heat before any drive has to protect its own winding, whatever force is requested.
#include "firmware/control/windings.hpp"

#include <gtest/gtest.h>

#include "tests/support/random.hpp"
#include "tests/unit/control/controller_rig.hpp"
#include "tests/unit/control/plain_device.hpp"

namespace ligature::control {
namespace {

constexpr double kGuard = 1.2;  // share of the continuous torque to which a drive limits itself when its winding is hot

/// Thermal model of an arm's windings as its drives compute it, rated 20 % above the device file; 1 = too hot.
struct Guarded {
  explicit Guarded(const device::Device& d) : most_Nm(kGuard * continuous_torque_Nm(d)), tau_s(d.thermal_time_s) {}
  void pass(const Vec3& torque_Nm) {
    const Vec3 load = torque_Nm.cwiseQuotient(most_Nm);
    heat += (load.cwiseAbs2() - heat) * kT_s / tau_s;
    hottest = std::max(hottest, heat.maxCoeff());
  }
  Vec3 most_Nm, heat = Vec3::Zero();
  double tau_s, hottest = 0.0;
};

/// A random device with an Omni's kinematics.
device::Device any_device(test::Random& random) {
  const auto share = [&] { return random.share(); };
  device::Device d = device::omni();
  d.continuous_force_N = 0.3 + 2.0 * share();
  d.peak_force_N = d.continuous_force_N * (1.2 + 6.0 * share());
  d.thermal_time_s = 2.0 + 30.0 * share();
  d.links_m = {0.1 + 0.1 * share(), 0.1 + 0.1 * share(), 0.0};
  d.home_tip_m[1] = -0.16 - 0.07 * share();
  return d;
}

/// Torques that jump, rest and oscillate, up to those of the peak force at home.
struct Wishes {
  test::Random& random;
  Vec3 most_Nm, now = Vec3::Zero();
  const Vec3& next() {
    const auto share = [&] { return random.share(); };
    const auto sign = [&] { return random.in(-1.0, 1.0); };
    const double dice = share();
    if (dice < 0.004) now = Vec3{sign(), sign(), sign()}.cwiseProduct(most_Nm);
    if (dice > 0.9985) now = most_Nm;
    if (dice > 0.9965 && dice < 0.9975) now = Vec3::Zero();
    return now;
  }
};

TEST(Windings, NoWishMakesADriveGuardItself) {
  test::Random random(56);
  for (int run = 0; run < 40; ++run) {
    const device::Device d = any_device(random);
    Windings windings(d, kT_s);
    Guarded drives(d);
    const double peak = d.peak_force_N / d.continuous_force_N;
    Wishes wishes{random, peak * continuous_torque_Nm(d)};
    for (int i = 0; i < 40'000; ++i) {
      const Vec3 wish = wishes.next();
      const Vec3 torque = wish * std::min(1.0, windings.share(wish));
      windings.sent(torque);
      drives.pass(torque);
      ASSERT_LT(drives.hottest, 1.0) << "peak " << peak << " times continuous, time constant " << d.thermal_time_s;
    }
  }
}

TEST(Windings, ThePeakHeldForEverGetsAsHotAsTheClosedFormSays) {
  const device::Device d = device::omni();
  Windings windings(d, kT_s);
  const double peak = d.peak_force_N / d.continuous_force_N;
  const Vec3 wish = peak * continuous_torque_Nm(d);
  double hottest = 0.0;
  for (int i = 0; i < 20'000; ++i) {
    windings.sent(wish * std::min(1.0, windings.share(wish)));
    hottest = std::max(hottest, windings.heat());
  }
  // The torque limit, as a multiple of the continuous torque, falls from `peak` to 1 in 0.5 s. Meanwhile the heat h
  // changes by dh/dt = (torque^2 - h) / thermal time. The mean of torque^2 in the fall is `square`; h is at least 1,
  // where the fall begins, and stays below 1.3 on average. So h rises by fall * (square - 1.3) to fall * (square - 1).
  const double fall = 0.5 / d.thermal_time_s, square = (peak * peak + peak + 1.0) / 3.0;
  EXPECT_LT(hottest, 1.0 + fall * (square - 1.0) + 1e-3);
  EXPECT_GT(hottest, 1.0 + fall * (square - 1.3));
  EXPECT_LT(hottest, kGuard * kGuard - 0.1);
  EXPECT_NEAR(windings.share(wish) * peak, 1.0, 1e-9) << "the continuous torque for ever";
}

TEST(Windings, WhatIsContinuousIsNeverTakenAway) {
  Windings windings(device::omni(), kT_s);
  const Vec3 wish = 0.999 * continuous_torque_Nm(device::omni());
  for (int i = 0; i < 100'000; ++i) {
    ASSERT_GE(windings.share(wish), 1.0) << i;
    windings.sent(wish);
  }
}

TEST(Windings, PeriodsThatWereLostWarmThemToo) {  // during lost periods the drives keep the last torque
  Windings each(device::omni(), kT_s), tenth(device::omni(), kT_s);
  const Vec3 torque(0.4, 0.1, 0.0);
  for (int i = 0; i < 500; ++i) each.sent(torque);
  for (int i = 0; i < 50; ++i) tenth.sent(torque, 10);
  EXPECT_NEAR(tenth.heat(), each.heat(), 0.03 * each.heat());
}

/// Largest winding heat after 12 s with the given pose and pull; both hands do the same.
double hottest_of(const JointAngles& pose, const Vec3& along) {
  Rig rig;
  for (auto& reading : rig.in.reading.hand) reading.q_rad = pose;
  Guarded drives(device::omni());
  for (int i = 0; i < 12'000; ++i) {
    for (std::size_t h = 0; h < rt::kHands; ++h)
      rig.in.grasp[h].p_WG = rig.controller.hand(h).p_WT + (i < 1000 ? 0.05 : 50.0) * along;
    const auto torque = rig.tick_as_is().hand[0].torque_Nm;
    drives.pass(vector_of(torque));
  }
  return drives.hottest;
}

// The continuous force of 0.88 N at full reach takes 1.4 times the waist's continuous torque.
TEST(Windings, NoPullInAnyPoseMakesADriveGuardItself) {
  test::Random random(56);
  const auto share = [&] { return random.share(); };
  const device::Device d = device::omni();
  double hottest = hottest_of({0.0, 0.45, 0.95}, Vec3::UnitX());
  EXPECT_LT(hottest, 1.0) << "the waist at full reach";
  for (int run = 0; run < 6; ++run) {
    const JointAngles pose{-0.4 + 0.8 * share(), 0.2 + 0.8 * share(), 0.4 + 0.7 * share()};
    const Vec3 along = Vec3{share() - 0.5, share() - 0.5, share() - 0.5}.normalized();
    const double heat = hottest_of(pose, along);
    EXPECT_LT(heat, 1.0) << pose[0] << ' ' << pose[1] << ' ' << pose[2] << " along " << along.transpose();
    hottest = std::max(hottest, heat);
  }
  EXPECT_GT(hottest, 0.5) << "a pull that warms nothing says nothing";
}

}  // namespace
}  // namespace ligature::control
