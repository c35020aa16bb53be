// The port's account against a plant of its own: exact, and never overdrawn by any hand within the bound.
#include "firmware/control/passivity.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace ligature::control {
namespace {

constexpr double kT_s = 1e-3;

/// Three drums of 1 m radius: torque = force, angle = metre. The physics are exact between samples.
device::Device plain() {
  device::Device d = device::omni();
  d.kinematics = device::Kinematics::kCartesian;
  d.links_m = {1, 1, 1};
  d.home_tip_m = {0, 0, 0};
  return d;
}

/// A mass that a hand and the motors push; `wish` is the law, the hand's force is given.
struct Port {
  explicit Port(bool active, double credit_J = 0.0) : passivity(plain(), kT_s, active, credit_J) {}

  template <class Wish>
  void tick(Wish wish, const Vec3& acceleration) {
    const JointAngles q{p.x(), p.y(), p.z()};
    passivity.observe(n, q, p, 0.0);
    lowest_J = std::min(lowest_J, passivity.energy_J());
    const Vec3 f = passivity.control(n, wish(p, v), v);
    passivity.sent(n, f, f);
    if (passivity.acts()) ++acted;
    const Vec3 moved = v * kT_s + 0.5 * acceleration * kT_s * kT_s;  // under a constant acceleration
    work_J -= acting.dot(moved);
    p += moved;
    v += acceleration * kT_s;
    acting = f;  // sent now, acts from the next SYNC on
    ++n;
  }

  Passivity passivity;
  Vec3 p = Vec3::Zero(), v = Vec3::Zero(), acting = Vec3::Zero();
  double lowest_J = 0.0, work_J = 0.0;
  int acted = 0;
  std::int64_t n = 0;
};

Vec3 saturated(const Vec3& f) { return f.norm() > 3.3 ? Vec3(f * (3.3 / f.norm())) : f; }
Vec3 spring(const Vec3& p, const Vec3&) { return -400.0 * p; }

TEST(Passivity, TheAccountIsTheWorkToTheLastDigit) {  // against the work summed by the plant itself
  Port port(false);
  for (int i = 0; i < 3000; ++i) port.tick(spring, 10.0 * Vec3(std::cos(0.02 * i), std::sin(0.03 * i), 0));
  const double before = port.work_J;
  port.tick(spring, Vec3::Zero());
  EXPECT_NEAR(port.passivity.energy_J(), before, 1e-12);
}

TEST(Passivity, ASampledSpringMakesEnergyAndTheControllerRefusesIt) {  // a full swing costs the hand less than it gets
  const auto swing = [](bool active) {
    Port port(active);
    port.v.x() = 0.02 * 40.0;  // 2 cm at 40 rad/s
    for (int i = 0; i < 2000; ++i) port.tick(spring, Vec3(-0.02 * 40.0 * 40.0 * std::sin(0.04 * (i + 0.5)), 0, 0));
    return port;
  };
  EXPECT_LT(swing(false).lowest_J, -1e-4);
  const Port held = swing(true);
  EXPECT_GE(held.lowest_J, -Passivity::kFloor_J);
  EXPECT_GT(held.acted, 0);
}

TEST(Passivity, NoHandWithinTheBoundOverdrawsTheAccount) {  // adversaries: jerks at full acceleration, always the worst
  std::mt19937 random(5);
  std::uniform_real_distribution<double> share(-1.0, 1.0);
  std::normal_distribution<double> any;
  const double a = plain().hand_acceleration_m_per_s2;
  for (int seed = 0; seed < 40; ++seed) {
    Port port(true);
    Vec3 push = Vec3::Zero();
    for (int i = 0; i < 3000; ++i) {
      if (i % (1 + seed % 17) == 0) push = Vec3(any(random), any(random), any(random)).normalized();
      const bool with_the_force = seed % 2 == 0 && !port.acting.isZero();
      Vec3 acceleration = a * (with_the_force ? Vec3(port.acting.normalized()) : push) * share(random);
      if (port.v.norm() > 1.0) acceleration = -a * port.v.normalized();
      const double gain = seed % 3 == 0 ? 400.0 : -400.0;  // a negative spring is a motor
      const auto law = [gain](const Vec3& p, const Vec3& v) { return saturated(gain * p + 0.5 * gain * 0.01 * v); };
      port.tick(law, acceleration);
    }
    EXPECT_GE(port.lowest_J, -Passivity::kFloor_J) << seed;
  }
}

TEST(Passivity, AMotorGetsNothingFromAHandThatNeverPaid) {  // constant force along the motion
  Port port(true);
  for (int i = 0; i < 1000; ++i) port.tick([](const Vec3&, const Vec3&) { return Vec3(1, 0, 0); }, Vec3(i < 100, 0, 0));
  EXPECT_LT(port.acting.norm(), 0.01);
  EXPECT_GE(port.lowest_J, -Passivity::kFloor_J);
}

TEST(Passivity, APaidSpringIsFeltInFull) {  // pull 1 cm slowly and hold: what the hand has paid it may feel
  Port port(true);
  const double rate = 2.0 * std::acos(-1.0);
  for (int i = 0; i < 2000; ++i) {
    const bool pulls = i < 500;
    port.tick(spring, Vec3(pulls ? 0.0025 * rate * rate * std::cos(rate * i * kT_s) : -50.0 * port.v.x(), 0, 0));
  }
  EXPECT_GT(port.p.norm(), 0.002);
  EXPECT_NEAR(port.acting.norm(), 400.0 * port.p.norm(), 0.01 * 400.0 * port.p.norm());
}

TEST(Passivity, CreditIsForgottenAboveTheWindow) {
  Port port(true);
  const auto drag = [](const Vec3&, const Vec3& v) { return saturated(-20.0 * v); };
  for (int i = 0; i < 20'000; ++i) port.tick(drag, Vec3(20.0 * std::cos(0.03 * i), 0, 0));
  EXPECT_DOUBLE_EQ(port.passivity.energy_J(), Passivity::kCredit_J);
}

TEST(Passivity, HandsShareWhatTheyHave) {
  Passivity a(plain(), kT_s, true, 0.003), b(plain(), kT_s, true, 0.001);
  Passivity::share(a, b);
  EXPECT_DOUBLE_EQ(a.energy_J(), 0.002);
  EXPECT_DOUBLE_EQ(b.energy_J(), 0.002);
}

}  // namespace
}  // namespace ligature::control
