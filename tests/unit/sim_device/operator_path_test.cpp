#include "sim_device/operator_path.hpp"

#include <gtest/gtest.h>

#include "ligature_source_dir.hpp"
#include "protocol/scene/gripper_script.hpp"
#include "tests/unit/sim_device/omni.hpp"

namespace ligature::sim {
namespace {

scene::GripperScript overhand() {
  return std::get<scene::GripperScript>(
      scene::load_gripper_script(LIGATURE_SOURCE_DIR "/scenes/operators/overhand.csv"));
}

Vec3 vec(const scene::Vec& v) { return {v[0], v[1], v[2]}; }

TEST(OperatorPath, PassesEveryKeyAtItsTimeAtRest) {
  for (const auto& keys : overhand().keys) {
    const auto made = OperatorPath::make(keys, paper_map());
    ASSERT_TRUE(std::holds_alternative<OperatorPath>(made)) << std::get<std::string>(made);
    const auto& path = std::get<OperatorPath>(made);
    for (const scene::GripKey& key : keys) {
      const Intent i = path.at(key.time_s);
      EXPECT_NEAR((i.p_DH - paper_map().to_device(vec(key.p_W_m))).norm(), 0.0, 1e-9);
      EXPECT_NEAR(i.v_DH.norm(), 0.0, 1e-9);
      EXPECT_EQ(i.grip, key.grip);
    }
    EXPECT_EQ(path.end_s(), keys.back().time_s);
  }
}

TEST(OperatorPath, StaysWithinTwoPercentOfTheSmoothstepOfTheLab) {
  for (const auto& keys : overhand().keys) {
    const auto path = std::get<OperatorPath>(OperatorPath::make(keys, paper_map()));
    for (std::size_t k = 0; k + 1 < keys.size(); ++k) {
      const double travel_m = (vec(keys[k + 1].p_W_m) - vec(keys[k].p_W_m)).norm();
      for (double u = 0.0; u < 1.0; u += 0.01) {
        const double t_s = keys[k].time_s + u * (keys[k + 1].time_s - keys[k].time_s);
        const Vec3 smooth = vec(scene::sample(keys, t_s).p_W_m);
        EXPECT_LE((paper_map().to_world(path.at(t_s).p_DH) - smooth).norm(), 0.021 * travel_m + 1e-3) << t_s;
      }
    }
  }
}

TEST(OperatorPath, VelocityIsTheDerivativeOfPosition) {
  const auto path = std::get<OperatorPath>(OperatorPath::make(overhand().keys[1], paper_map()));
  constexpr double h = 1e-6;
  for (double t_s = 0.01; t_s < 21.0; t_s += 0.0137) {
    const Vec3 slope = (path.at(t_s + h).p_DH - path.at(t_s - h).p_DH) / (2 * h);
    EXPECT_NEAR((slope - path.at(t_s).v_DH).norm(), 0.0, 1e-5) << t_s;
  }
}

TEST(OperatorPath, HoldsBeforeAndAfter) {
  const auto path = std::get<OperatorPath>(OperatorPath::make(overhand().keys[0], paper_map()));
  EXPECT_EQ(path.at(-1.0).p_DH, path.at(0.0).p_DH);
  EXPECT_FALSE(path.at(-1.0).grip);
  EXPECT_EQ(path.at(1e6).p_DH, path.at(21.0).p_DH);
}

TEST(OperatorPath, RefusesAKeyOutOfReachByItsTime) {
  const std::vector<scene::GripKey> keys{{0.0, {0.5, -0.4, 3.2}, false}, {2.5, {9.0, 0.0, 3.0}, true}};
  const auto made = OperatorPath::make(keys, paper_map());
  ASSERT_TRUE(std::holds_alternative<std::string>(made));
  EXPECT_NE(std::get<std::string>(made).find("2.5"), std::string::npos);
  EXPECT_EQ(std::get<std::string>(made).find("mm"), std::string::npos) << "9 mm are out of its reach, too";
}

TEST(OperatorPath, AsksForMillimetresWhenTheyWouldBeInReach) {
  auto keys = overhand().keys[0];
  for (auto& key : keys)
    for (double& x : key.p_W_m) x *= 1e3;
  const auto made = OperatorPath::make(keys, paper_map());
  ASSERT_TRUE(std::holds_alternative<std::string>(made));
  EXPECT_NE(std::get<std::string>(made).find("in mm?"), std::string::npos) << std::get<std::string>(made);
}

TEST(OperatorPath, AnAbsentHandRestsAtHome) {
  const auto path = std::get<OperatorPath>(OperatorPath::make({}, paper_map()));
  EXPECT_EQ(path.at(3.0).p_DH, home_tip_D_m());
  EXPECT_FALSE(path.at(3.0).grip);
}

}  // namespace
}  // namespace ligature::sim
