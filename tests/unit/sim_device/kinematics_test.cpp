#include "sim_device/kinematics.hpp"

#include <gtest/gtest.h>

#include "ligature_source_dir.hpp"
#include "protocol/device/device_file.hpp"
#include "sim_device/plant.hpp"
#include "tests/support/random.hpp"
#include "tests/unit/sim_device/omni.hpp"

namespace ligature::sim {
namespace {

const double kUpperArm_m = device::omni().links_m[0], kForearm_m = device::omni().links_m[1];

Vec3 random_joints(test::Random& random) {
  const auto waist = [&] { return random.in(-0.9, 0.9); };
  const auto shoulder = [&] { return random.in(0.0, 1.7); };
  const auto elbow = [&] { return random.in(-0.75, 1.2); };
  const double q2 = shoulder();
  return {waist(), q2, q2 + elbow()};
}

TEST(Kinematics, HomeIsWhereItIsSaidToBe) {
  const auto q = joints_of_tip(home_tip_D_m());
  ASSERT_TRUE(q);
  EXPECT_TRUE(Linkage().is_within_stops(*q));
  EXPECT_NEAR((tip_D_m(*q) - Vec3(0.0, -0.17, 0.0)).norm(), 0.0, 1e-12);
}

TEST(Kinematics, AnglesOfATipLeadBackToIt) {  // over the whole reach within the joint stops
  test::Random random(11);
  for (int i = 0; i < 2000; ++i) {
    const Vec3 q = random_joints(random);
    const Vec3 p_DT = tip_D_m(q);
    if (std::hypot(p_DT.x(), p_DT.y()) < 1e-3) continue;  // on the waist axis q1 is undetermined
    const auto back = joints_of_tip(p_DT);
    ASSERT_TRUE(back);
    EXPECT_NEAR((tip_D_m(*back) - p_DT).norm(), 0.0, 1e-12);
  }
}

TEST(Kinematics, LinksHaveTheirLengths) {  // closed forms, independent of the angles' conventions
  EXPECT_NEAR(tip_D_m({0.0, 0.0, std::acos(-1.0) / 2}).norm(), kUpperArm_m + kForearm_m, 1e-12);  // stretched forwards
  EXPECT_NEAR((tip_D_m({0.0, 0.0, 0.0}) - Vec3(0.0, -kUpperArm_m, -kForearm_m)).norm(), 0.0, 1e-12);
}

TEST(Kinematics, JacobianIsTheDerivativeOfTheTip) {  // central difference, error of order h^2
  test::Random random(12);
  constexpr double h = 1e-6;
  for (int i = 0; i < 200; ++i) {
    const Vec3 q = random_joints(random);
    for (int j = 0; j < 3; ++j) {
      const Vec3 dq = h * Vec3::Unit(j);
      EXPECT_NEAR(((tip_D_m(q + dq) - tip_D_m(q - dq)) / (2 * h) - tip_jacobian_D(q).col(j)).norm(), 0.0, 1e-9);
    }
  }
}

TEST(Kinematics, OutOfReachIsRefused) {
  EXPECT_FALSE(joints_of_tip({0.0, -0.27, 0.0}));
  EXPECT_FALSE(joints_of_tip({0.0, 0.0, 0.0}));
}

TEST(Linkage, ACartesianDeviceComesBackToItsJointsAndItsJacobianIsItsSlope) {
  const auto read = device::load_device(LIGATURE_SOURCE_DIR "/scenes/devices/cartesian.toml");
  ASSERT_TRUE(std::holds_alternative<device::Device>(read)) << std::get<scene::Error>(read).text;
  const auto& record = std::get<device::Device>(read);
  const Linkage linkage(record);
  const Vec3 q{0.5, -1.0, 2.0};
  EXPECT_NEAR((*linkage.joints(linkage.tip_D_m(q)) - q).norm(), 0.0, 1e-12);
  EXPECT_NEAR((linkage.tip_D_m(q) - Vec3(0.01, -0.02, 0.04)).norm(), 0.0, 1e-12);
  EXPECT_NEAR((linkage.jacobian_D(q) - Mat3(0.02 * Mat3::Identity())).norm(), 0.0, 1e-12);
  EXPECT_TRUE(linkage.is_within_stops(q));
  EXPECT_FALSE(linkage.is_within_stops({0.0, 7.1, 0.0}));
}

TEST(Linkage, TheShippedRecordIsTheDeviceThatIsBuiltIn) {
  const PlantParameters built_in, record = PlantParameters::of(device::omni());
  EXPECT_LT((record.inertia_kg_m2 - built_in.inertia_kg_m2).norm(), 1e-5);
  EXPECT_LT((record.coulomb_Nm - built_in.coulomb_Nm).norm(), 1e-4);
  EXPECT_LT((record.viscous_Nm_s - built_in.viscous_Nm_s).norm(), 1e-4);
  EXPECT_DOUBLE_EQ(record.max_torque_Nm, built_in.max_torque_Nm);
  for (const Vec3& q : {Vec3(0.1, 0.6, 0.5), Vec3(-0.7, 1.2, 1.5)}) {
    EXPECT_NEAR((record.linkage.tip_D_m(q) - built_in.linkage.tip_D_m(q)).norm(), 0.0, 1e-12);
    EXPECT_EQ(record.linkage.is_within_stops(q), built_in.linkage.is_within_stops(q));
  }
}

TEST(Plant, AnyDevicePushesBackAsItsRecordSays) {  // mass and friction at the tip, along each axis in the home pose
  const auto cartesian =
      std::get<device::Device>(device::load_device(LIGATURE_SOURCE_DIR "/scenes/devices/cartesian.toml"));
  const PlantParameters p = PlantParameters::of(cartesian);
  for (int axis = 0; axis < 3; ++axis) {
    Plant plant(*p.linkage.joints(p.linkage.home_D_m()), p);
    plant.step(Vec3::Zero(), (1.0 + cartesian.coulomb_N) * Vec3::Unit(axis), 1e-6);  // 1 N more than friction
    EXPECT_NEAR(plant.tip_velocity_D_m_per_s()[axis], 1e-6 / cartesian.apparent_mass_kg, 1e-9);
  }
}

}  // namespace
}  // namespace ligature::sim
