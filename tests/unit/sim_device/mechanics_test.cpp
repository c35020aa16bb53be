#include "sim_device/mechanics.hpp"

#include <gtest/gtest.h>

#include "ligature_source_dir.hpp"
#include "protocol/scene/gripper_script.hpp"
#include "tests/unit/sim_device/omni.hpp"
#include "tests/unit/sim_device/virtual_master.hpp"

namespace ligature::sim {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

std::vector<scene::GripKey> overhand(int hand) {
  return std::get<scene::GripperScript>(
             scene::load_gripper_script(LIGATURE_SOURCE_DIR "/scenes/operators/overhand.csv"))
      .keys[hand];
}

// The simulated hand moves the device with soft fingers against joint friction; the thread exerts no force.
TEST(Mechanics, TheTipReachesEveryKeyWithinAMillimetre) {
  for (const int hand : {0, 1}) {
    const auto keys = overhand(hand);
    Mechanics m(path_of(keys), Time(0));
    m.start_script(Time(0));
    std::size_t next = 0;
    for (Time t{}; next < keys.size(); t += milliseconds(1)) {
      m.advance(t, Vec3::Zero());
      ASSERT_LT((m.plant().tip_D_m() - m.intent().p_DH).norm(), 2e-3) << "at " << t.count() << " ns";
      if (t < Time(static_cast<std::int64_t>(keys[next].time_s * 1e9))) continue;
      EXPECT_LT((m.plant().tip_D_m() - path_of(keys).at(keys[next].time_s).p_DH).norm(), 1e-3) << keys[next].time_s;
      ++next;
    }
  }
}

TEST(Mechanics, DeadManIsHeldFromTheStartUntilASecondAfterTheLastKey) {
  Mechanics m(path_of({{0.0, {0.5, -0.4, 3.2}, true}, {1.0, {0.5, -0.4, 3.4}, false}}), Time(0));
  m.advance(seconds(1), Vec3::Zero());
  EXPECT_EQ(m.buttons(), 0);  // the script has not started
  m.start_script(seconds(1));
  EXPECT_EQ(m.buttons(), can::profile::kButtonGrip | can::profile::kButtonDeadMan);
  m.advance(milliseconds(2500), Vec3::Zero());
  EXPECT_EQ(m.buttons(), can::profile::kButtonDeadMan);
  EXPECT_FALSE(m.is_done());
  m.advance(milliseconds(3001), Vec3::Zero());
  EXPECT_EQ(m.buttons(), 0);
  EXPECT_TRUE(m.is_done());
}

TEST(Mechanics, TimeMayComeInAnyPortions) {  // the same motion in steps of 1 ms and of 0.1 ms
  const auto keys = overhand(1);
  Mechanics a(path_of(keys), Time(0)), b(path_of(keys), Time(0));
  a.start_script(Time(0));
  b.start_script(Time(0));
  for (int i = 1; i <= 1500; ++i) a.advance(milliseconds(i), {0.02, -0.03, 0.04});
  for (int i = 1; i <= 15000; ++i) b.advance(std::chrono::microseconds(100 * i), {0.02, -0.03, 0.04});
  EXPECT_NEAR((a.plant().tip_D_m() - b.plant().tip_D_m()).norm(), 0.0, 1e-12);
}

TEST(Mechanics, APullOfTheMotorsIsFeltAsGivingWay) {  // 1 N at the tip over 800 N/m, less what friction holds
  Mechanics m(path_of(), Time(0));
  const Vec3 force_D_N{0.0, 0.0, 1.0};
  m.advance(seconds(2), tip_jacobian_D(m.plant().q_rad()).transpose() * force_D_N);
  const double give_m = (m.plant().tip_D_m() - home_tip_D_m()).z();
  EXPECT_GT(give_m, 0.8 / 800.0);
  EXPECT_LT(give_m, 1.1 / 800.0);
}

}  // namespace
}  // namespace ligature::sim
