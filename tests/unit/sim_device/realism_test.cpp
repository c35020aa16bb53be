// Each physical law of the simulated device and hand, compared with its closed form.
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <numbers>

#include "sim_device/mechanics.hpp"
#include "sim_device/unrest.hpp"
#include "tests/unit/sim_device/omni.hpp"
#include "tests/unit/sim_device/virtual_master.hpp"

namespace ligature::sim {
namespace {

using std::chrono::microseconds;
using std::chrono::seconds;
constexpr double kWaistLever_m = 0.17;
// Apparent mass for sideways motion by the waist alone: 45 g.
constexpr double kTipMass_kg = 1.30e-3 / (kWaistLever_m * kWaistLever_m);

PlantParameters frictionless() {
  PlantParameters p;
  p.coulomb_Nm = p.viscous_Nm_s = Vec3::Zero();
  return p;
}

/// A hand that stays at home.
std::unique_ptr<HeldIntention> resting() { return std::make_unique<HeldIntention>(home_tip_D_m()); }

/// Motor torque that pulls the tip sideways with `force_N`.
Vec3 sideways(double force_N) { return {force_N * kWaistLever_m, 0.0, 0.0}; }

/// Free oscillation of the tip: deflected sideways by the motor with force_N, released, and sampled every 0.1 ms.
std::vector<double> ring(Mechanics& m, double force_N, double time_s) {
  m.advance(seconds(1), sideways(force_N));
  std::vector<double> x;
  for (int i = 1; i * 1e-4 < time_s; ++i) {
    m.advance(seconds(1) + microseconds(100 * i), Vec3::Zero());
    x.push_back(m.plant().tip_D_m().x());
  }
  return x;
}

/// Frequency of an oscillation sampled every 0.1 ms, from its rising zero crossings, interpolated linearly.
double frequency_Hz(const std::vector<double>& x) {
  std::vector<double> at;
  for (std::size_t i = 1; i < x.size(); ++i)
    if (x[i - 1] < 0.0 && x[i] >= 0.0) at.push_back(static_cast<double>(i) - x[i] / (x[i] - x[i - 1]));
  return at.size() < 2 ? 0.0 : static_cast<double>(at.size() - 1) / (at.back() - at.front()) * 1e4;
}

double natural_Hz(double stiffness, double mass) { return std::sqrt(stiffness / mass) / (2.0 * std::numbers::pi); }

TEST(Realism, TheReflectedMassRingsOnTheHandsSpring) {
  Body body{frictionless(), {500.0, 0.0}, {}, {}};
  Mechanics m(resting(), Time(0), body);
  EXPECT_NEAR(frequency_Hz(ring(m, 0.3, 2.0)), natural_Hz(500.0, kTipMass_kg), 0.05);
}

TEST(Realism, TheHandsMassRidesOnTheDevice) {
  Body body{frictionless(), {300.0, 0.0, 0.1, 2e5, 20.0}, {}, {}};
  Mechanics m(resting(), Time(0), body);
  EXPECT_NEAR(frequency_Hz(ring(m, 0.2, 3.0)), natural_Hz(300.0, kTipMass_kg + 0.1), 0.03);
}

TEST(Realism, BentLinksRingBetweenTheirTwoMasses) {
  Compliance c = Compliance::of_the_class();
  c.damping_N_s_per_m = 0.0;
  Body body{frictionless(), {5.0, 0.01}, c, {}};
  Mechanics m(resting(), Time(0), body);
  const double both = 1.0 / (1.0 / kTipMass_kg + 1.0 / c.tip_mass_kg);
  const double expected = natural_Hz(c.stiffness_N_per_m.x(), both);  // 63 Hz
  std::vector<double> bend;
  for (int i = 1; i < 2000; ++i) {  // excited by a motor torque of 1 ms
    m.advance(microseconds(100 * i), sideways(i <= 10 ? 3.0 : 0.0));
    bend.push_back(m.touch().p_DT.x() - m.plant().tip_D_m().x());
  }
  EXPECT_NEAR(frequency_Hz(bend), expected, 0.02 * expected);
}

TEST(Realism, StaticErrorIsForceOverTheSpringsInSeries) {
  Hand hand = Hand::holding(0.5);
  Body body{frictionless(), hand, Compliance::of_the_class(), {}};
  Mechanics m(resting(), Time(0), body);
  m.advance(seconds(5), sideways(0.5));
  const double linkage = m.plant().tip_D_m().x();
  const double tip = m.touch().p_DT.x(), finger = m.fingers().position_D_m().x();
  // The motor's torque is constant, but the waist's lever turns with the waist angle q1, so the sideways force is 0.5 N
  // / cos q1.
  const double force = 0.5 / std::cos(m.plant().q_rad()[0]);
  EXPECT_NEAR(finger, force / hand.stiffness_N_per_m, 0.01 * finger);
  EXPECT_NEAR(tip - finger, force / hand.pad_stiffness_N_per_m, 0.02 * (tip - finger));
  EXPECT_NEAR(linkage - tip, force / 1260.0, 0.02 * (linkage - tip));
}

TEST(Realism, FrictionHoldsAHandsPullBelowItsBand) {  // the friction band is 0.1 N at the tip
  const double band_N = PlantParameters{}.coulomb_Nm[0] / kWaistLever_m;
  for (const double share : {0.98, 1.02}) {
    auto will = resting();
    will->set(0.0, {home_tip_D_m() + Vec3(share * band_N / 400.0, 0, 0), Vec3::Zero(), false});
    Mechanics m(std::move(will), Time(0), {{}, {400.0, 0.0}, {}, {}});
    m.start_script(Time(0));
    m.advance(seconds(1), Vec3::Zero());
    if (share < 1.0)
      EXPECT_EQ(m.plant().q_rad()[0], 0.0) << "held";
    else
      EXPECT_GT(m.plant().tip_D_m().x(), 0.0) << "slips";
  }
}

TEST(Realism, WeightWithoutFrictionKeepsItsEnergy) {
  PlantParameters p = frictionless();
  p.gravity_compensation = 0.0;
  device::Device free = device::omni();
  free.joint_min_rad = {-50.0, -50.0, -50.0};
  free.joint_max_rad = {50.0, 50.0, 50.0};
  p.linkage = Linkage(free);
  Plant plant(*joints_of_tip(home_tip_D_m()), p);
  const double start_J = plant.kinetic_J() + plant.potential_J();
  double swing_J = 0.0;
  for (int i = 0; i < 50000; ++i) {
    plant.step(Vec3::Zero(), Vec3::Zero(), 1e-4);
    swing_J = std::max(swing_J, plant.kinetic_J());
    ASSERT_NEAR(plant.kinetic_J() + plant.potential_J(), start_J, 2e-3 * 0.1) << i;  // relative to a swing of 0.1 J
  }
  EXPECT_GT(swing_J, 0.05);
}

TEST(Realism, WhatIsLeftOfTheWeightIsATenthOfANewtonAndFrictionHoldsIt) {
  PlantParameters p;
  p.gravity_compensation = 0.8;
  Plant plant(*joints_of_tip(home_tip_D_m()), p);
  const Vec3 force = tip_jacobian_D(plant.q_rad()).transpose().inverse() * plant.gravity_Nm();
  EXPECT_NEAR(force.norm(), 0.1, 0.05);
  for (int i = 0; i < 10000; ++i) plant.step(Vec3::Zero(), Vec3::Zero(), 1e-4);
  EXPECT_EQ(plant.q_rad(), *joints_of_tip(home_tip_D_m()));
}

/// The work done on device and hand equals the energy stored plus the energy dissipated, to 1 % of the work.
TEST(Realism, EnergyBalances) {
  const Hand hand = Hand::holding(0.6);
  PlantParameters p;
  p.gravity_compensation = 0.8;
  const Compliance c = Compliance::of_the_class();
  Plant plant(*joints_of_tip(home_tip_D_m()), p);
  Fingers fingers(hand, plant.tip_D_m());
  Stylus stylus(c, plant.tip_D_m());
  const double dt = 1e-5;
  const double start_J = plant.potential_J();
  double work_J = 0.0, lost_J = 0.0;
  for (int i = 0; i < 100000; ++i) {
    const double t = i * dt;
    const Vec3 motor = 0.03 * Vec3(std::sin(20 * t), std::sin(31 * t), std::sin(13 * t));
    const Vec3 p_L = plant.tip_D_m(), v_L = plant.tip_velocity_D_m_per_s(), omega = plant.omega_rad_per_s();
    const Vec3 v_T = stylus.velocity_D_m_per_s(), v_F = fingers.velocity_D_m_per_s();
    const Vec3 pad = fingers.step(home_tip_D_m(), Vec3::Zero(), stylus.position_D_m(), v_T, dt);
    const Vec3 bend = stylus.step(pad, p_L, v_L, dt);
    plant.step(motor, bend, dt);
    const Vec3 mean = 0.5 * (omega + plant.omega_rad_per_s());
    work_J += dt * motor.dot(mean);
    lost_J +=
        dt * (hand.damping_N_s_per_m * v_F.squaredNorm() + hand.pad_damping_N_s_per_m * (v_F - v_T).squaredNorm() +
              c.damping_N_s_per_m * (v_T - v_L).squaredNorm() + p.viscous_Nm_s.dot(mean.cwiseAbs2()) +
              p.coulomb_Nm.dot(mean.cwiseAbs()));
  }
  const Vec3 arm = fingers.position_D_m() - home_tip_D_m(), pad = fingers.position_D_m() - stylus.position_D_m();
  const Vec3 bend = stylus.position_D_m() - plant.tip_D_m();
  const double stored_J = plant.kinetic_J() + plant.potential_J() - start_J +
                          0.5 * hand.mass_kg * fingers.velocity_D_m_per_s().squaredNorm() +
                          0.5 * c.tip_mass_kg * stylus.velocity_D_m_per_s().squaredNorm() +
                          0.5 * hand.stiffness_N_per_m * arm.squaredNorm() +
                          0.5 * hand.pad_stiffness_N_per_m * pad.squaredNorm() +
                          0.5 * bend.dot(c.stiffness_N_per_m.cwiseProduct(bend));
  EXPECT_GT(work_J, 1e-4);
  EXPECT_NEAR(work_J, stored_J + lost_J, 0.01 * work_J);
}

TEST(Realism, AMotorAtTwiceItsRatingIsHeldDownWhenItsWindingIsHot) {
  MotorHeat motors;
  const MotorRating rating;
  const double expected_s = -rating.time_constant_s * std::log(1.0 - 1.0 / 4.0);  // 5.8 s
  double held_at_s = 0.0;
  const Vec3 twice = 2.0 * rating.continuous_Nm;
  for (int i = 0; i < 200000; ++i) {
    const Vec3 passed = motors.pass(twice, 1e-4);
    if (held_at_s == 0.0 && motors.is_holding()) held_at_s = i * 1e-4;
    if (held_at_s > 0.0 && motors.is_holding()) {
      ASSERT_EQ(passed, rating.continuous_Nm);
    }
  }
  EXPECT_NEAR(held_at_s, expected_s, 0.01);
  for (int i = 0; i < 20000; ++i) motors.pass(Vec3::Zero(), 1e-4);  // after 2 s of rest the heat is below 0.95
  EXPECT_EQ(motors.pass(twice, 1e-4), twice);
}

TEST(Realism, TheNominalTorqueNeverWarmsAMotorUp) {
  MotorHeat motors;
  for (int i = 0; i < 2000000; ++i) {
    const Vec3 passed = motors.pass(MotorRating{}.continuous_Nm, 1e-3);
    ASSERT_EQ(passed, MotorRating{}.continuous_Nm);
  }
  EXPECT_LE(motors.heat().maxCoeff(), 1.0);
}

TEST(Realism, ATighterHandIsStifferHeavierAndDampsMore) {
  Hand last = Hand::absent();
  for (double t = 0.0; t <= 1.0; t += 0.125) {
    const Hand hand = Hand::holding(t);
    EXPECT_GT(hand.stiffness_N_per_m, last.stiffness_N_per_m);
    EXPECT_GT(hand.damping_N_s_per_m, last.damping_N_s_per_m);
    EXPECT_GT(hand.mass_kg, last.mass_kg);
    last = hand;
  }
}

TEST(Realism, ATremblingHandShakesByItsAmplitudeAtItsFrequency) {
  const Trembling will(resting(), 0.5e-3, 10.0);
  std::vector<double> z;
  double most = 0.0;
  for (int i = 1; i < 20000; ++i) {
    const double t = i * 1e-4;
    const Intent now = will.at(t, {});
    z.push_back((now.p_DH - home_tip_D_m()).y());
    most = std::max(most, std::abs(z.back()));
    const Vec3 slope = (will.at(t + 1e-6, {}).p_DH - will.at(t - 1e-6, {}).p_DH) / 2e-6;
    ASSERT_NEAR((slope - now.v_DH).norm(), 0.0, 1e-6);
  }
  EXPECT_NEAR(most, 0.5e-3, 1e-6);
  EXPECT_NEAR(frequency_Hz(z), 10.0, 0.1);
  EXPECT_EQ(will.at(-1.0, {}).p_DH, home_tip_D_m()) << "calm before the start";
}

/// A spring at the device (made by the motor, without delay): a calm hand brings it to rest, an adversary excites it.
TEST(Realism, AnAdversaryPutsEnergyIntoWhatACalmHandBringsToRest) {
  const auto end_speed = [](std::unique_ptr<Intention> will) {
    Mechanics m(std::move(will), Time(0), {{}, Hand{300.0, 1.0}, {}, {}});
    m.start_script(Time(0));
    m.advance(Time(microseconds(20000)), sideways(1.0));
    double last = 0.0;
    for (int i = 1; i < 20000; ++i) {
      m.advance(microseconds(20000 + 100 * i), Vec3::Zero());
      if (i > 15000) last = std::max(last, m.touch().v_DT.norm());
    }
    return last;
  };
  EXPECT_LT(end_speed(resting()), 1e-6);
  EXPECT_GT(end_speed(std::make_unique<Adversarial>(resting(), 0.02, 0.005)), 0.05);
}

}  // namespace
}  // namespace ligature::sim
