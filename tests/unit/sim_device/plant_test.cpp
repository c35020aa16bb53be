#include "sim_device/plant.hpp"

#include <gtest/gtest.h>

#include "sim_device/hand.hpp"
#include "tests/support/random.hpp"
#include "tests/unit/sim_device/omni.hpp"

namespace ligature::sim {
namespace {

constexpr double kStep_s = 1e-4;

Vec3 home_joints() { return *joints_of_tip(home_tip_D_m()); }

/// A plant after `steps` steps with the given motor torque.
Plant moving(const PlantParameters& parameters, const Vec3& q_rad, const Vec3& motor_Nm, int steps = 100) {
  Plant plant(q_rad, parameters);
  for (int i = 0; i < steps; ++i) plant.step(motor_Nm, Vec3::Zero(), kStep_s);
  return plant;
}

TEST(Plant, KineticEnergyNeverGrowsWithoutTorque) {  // with friction, and stops without rebound
  test::Random random(21);
  const auto torque = [&] { return random.in(-0.9, 0.9); };
  for (int run = 0; run < 50; ++run) {
    Plant plant = moving({}, home_joints(), {torque(), torque(), torque()});
    double energy_J = plant.kinetic_J();
    for (int i = 0; i < 20000; ++i) {
      plant.step(Vec3::Zero(), Vec3::Zero(), kStep_s);
      ASSERT_LE(plant.kinetic_J(), energy_J * (1 + 1e-12));
      energy_J = plant.kinetic_J();
    }
    EXPECT_EQ(energy_J, 0.0) << "dry friction brings it to rest";
  }
}

TEST(Plant, StaysWithinItsStopsUnderFullTorque) {
  for (const double sign : {-1.0, 1.0}) {
    for (const Vec3& direction : {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1), Vec3(1, 1, -1)}) {
      Plant plant(home_joints());
      for (int i = 0; i < 5000; ++i) plant.step(sign * 5.0 * direction, Vec3::Zero(), kStep_s);
      const Vec3 q = plant.q_rad();
      EXPECT_LE(std::abs(q[0]), plant.parameters().linkage.max_rad()[0]);
      EXPECT_GE(q[1], plant.parameters().linkage.min_rad()[1]);
      EXPECT_LE(q[1], plant.parameters().linkage.max_rad()[1]);
      EXPECT_NEAR(
          q[2] - q[1],
          std::clamp(q[2] - q[1], plant.parameters().linkage.min_rad()[2], plant.parameters().linkage.max_rad()[2]),
          1e-12);
    }
  }
}

TEST(Plant, DryFrictionHoldsAJointBelowItsCoulombTorque) {
  const PlantParameters p;
  const Plant held = moving(p, home_joints(), 0.99 * p.coulomb_Nm, 1000);
  EXPECT_EQ(held.q_rad(), home_joints());
  const Plant slips = moving(p, home_joints(), 1.01 * p.coulomb_Nm, 1000);
  EXPECT_GT(slips.q_rad()[1], home_joints()[1]);
}

TEST(Plant, FrictionlessJointFollowsNewton) {  // omega = tau t / I, exact for semi-implicit Euler
  PlantParameters p;
  p.coulomb_Nm.setZero();
  p.viscous_Nm_s.setZero();
  const Plant plant = moving(p, home_joints(), {0.01, 0.0, 0.0}, 100);
  EXPECT_NEAR(plant.omega_rad_per_s()[0], 0.01 * 100 * kStep_s / p.inertia_kg_m2[0], 1e-12);
}

TEST(Plant, TorqueIsLimited) {
  PlantParameters p;
  p.coulomb_Nm.setZero();
  EXPECT_EQ(moving(p, home_joints(), {50.0, 0.0, 0.0}, 1).omega_rad_per_s()[0],
            moving(p, home_joints(), {0.9, 0.0, 0.0}, 1).omega_rad_per_s()[0]);
}

TEST(Plant, MotorTorqueJTransposeFBalancesAForceAtTheTip) {  // statics by virtual work, in poses over the whole reach
  PlantParameters p;
  p.coulomb_Nm.setZero();
  for (const Vec3& tip : {Vec3(0.0, -0.17, 0.0), Vec3(0.06, -0.15, 0.05), Vec3(-0.07, -0.19, -0.03)}) {
    const Vec3 q = *joints_of_tip(tip);
    const Vec3 force_D_N{1.2, -2.0, 2.2};
    Plant plant(q, p);
    for (int i = 0; i < 1000; ++i) plant.step(-tip_jacobian_D(q).transpose() * force_D_N, force_D_N, kStep_s);
    EXPECT_NEAR((plant.tip_D_m() - tip).norm(), 0.0, 1e-9);
  }
}

TEST(Plant, ApparentMassAtTheHomePoseIsAbout45Grams) {  // 1 / (u' J I^-1 J' u), u axis, J Jacobian, I inertia
  const Mat3 jacobian = tip_jacobian_D(home_joints());
  const Mat3 mobility = jacobian * PlantParameters{}.inertia_kg_m2.cwiseInverse().asDiagonal() * jacobian.transpose();
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_GT(1.0 / mobility(axis, axis), 0.02);
    EXPECT_LT(1.0 / mobility(axis, axis), 0.10);
  }
}

TEST(Hand,
     // Spring plus kinetic energy, up to the integrator's O(h) oscillation.
     BringsTheDeviceToItsPointAndTheEnergyFalls) {
  const Hand hand;
  const Vec3 anchor = home_tip_D_m() + Vec3(0.02, 0.01, 0.015);
  Plant plant(home_joints());
  const auto energy = [&] {
    return plant.kinetic_J() + 0.5 * hand.stiffness_N_per_m * (anchor - plant.tip_D_m()).squaredNorm();
  };
  double before_J = energy();
  const double start_J = before_J;
  for (int i = 0; i < 20000; ++i) {
    plant.step(Vec3::Zero(), hand.arm_force_D_N(anchor, Vec3::Zero(), plant.tip_D_m(), plant.tip_velocity_D_m_per_s()),
               kStep_s);
    ASSERT_LE(energy(), before_J + 1e-4 * start_J);
    before_J = energy();
  }
  EXPECT_LT((plant.tip_D_m() - anchor).norm(), 5e-4);  // remaining error: about 0.1 N of dry friction over 800 N/m
}

}  // namespace
}  // namespace ligature::sim
