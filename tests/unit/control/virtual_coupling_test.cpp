// Force of the virtual coupling between tool and held point: signs, scale and limits.
#include "firmware/control/virtual_coupling.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include <limits>

#include "firmware/control/admissible.hpp"
#include "firmware/control/workspace_map.hpp"
#include "ligature_source_dir.hpp"
#include "protocol/scene/scene_file.hpp"
#include "tests/support/random.hpp"
#include "tests/unit/control/plain_device.hpp"

namespace ligature::control {
namespace {

using physics::Vec3;

scene::Hands hands() {
  scene::Hands h;
  h.coupling_N_per_m = 1200.0;
  h.coupling_N_s_per_m = 6.0;
  h.force_scale = 0.003;
  h.max_force_N = 3.3;
  return h;
}

TEST(Saturate, NeverAboveTheLimitHoweverItIsMeasured) {
  test::Random random(3);
  const auto normal = [&] { return 20.0 * random.normal(); };
  for (int i = 0; i < 100'000; ++i) {
    const Vec3 wanted{normal(), normal(), normal()};
    const auto f = saturate(wanted, 3.3).f_N;
    ASSERT_LE(f.norm(), 3.3);
    ASSERT_LE(std::hypot(f.x(), f.y(), f.z()), 3.3);
    ASSERT_LE(std::sqrt(f.x() * f.x() + f.y() * f.y() + f.z() * f.z()), 3.3);
  }
}

/// The force with a resting device, in the steady state.
Vec3 felt(const scene::Hands& h, const Grasp& grasp, const Vec3& p_WT = Vec3::Zero(), const Vec3& v_WT = Vec3::Zero()) {
  const VirtualCoupling coupling(h, kT_s);
  Proxy proxy{p_WT, v_WT};
  for (int i = 0; i < 2000; ++i) static_cast<void>(coupling.pull(grasp, p_WT, v_WT, proxy));
  return coupling.pull(grasp, p_WT, v_WT, proxy).f_N;
}

TEST(VirtualCoupling, AnEmptyHandFeelsNothing) {
  EXPECT_EQ(felt(hands(), {false, Vec3(1, 1, 1), Vec3::Zero()}), Vec3::Zero());
}

TEST(VirtualCoupling, PullsTowardsTheNode) {  // node 0.1 m above: 1200 N/m x 0.1 m x force scale 0.003 = 0.36 N
  EXPECT_NEAR(felt(hands(), {true, Vec3(0, 0, 0.1), Vec3::Zero()}).z(), 0.36, 1e-12);
}

TEST(VirtualCoupling, ResistsTheHandsOwnMotion) {  // damping dissipates: the force opposes the velocity
  EXPECT_NEAR(felt(hands(), {true, Vec3::Zero(), Vec3::Zero()}, Vec3::Zero(), Vec3(2, 0, 0)).x(), -6.0 * 2 * 0.003,
              1e-12);
}

scene::Hands two_sided() {
  scene::Hands h = hands();
  h.workspace_scale = 20.0;  // at the device: 1200 x 0.003 x 20 = 72 N/m
  h.device_N_per_m = 36.0;
  return h;
}

// 72 and 36 N/m in series: 24 N/m; 0.1 m in the world is 5 mm at the device
TEST(VirtualCoupling, TwoSidesAreSpringsInSeries) {
  EXPECT_NEAR(felt(two_sided(), {true, Vec3(0, 0, 0.1), Vec3::Zero()}).z(), 24.0 * 0.005, 1e-9);
}

// The tool is held in place but told to move at 2 m/s, which is 0.1 m/s at the device. In the steady state the proxy
// rests where both sides' forces are equal, F = -B v + K_d x = -K_t x. With B = 0.5 N s/m, K_d = 36 and K_t = 72 N/m
// that is F = -B v K_t / (K_d + K_t) = -0.1 / 3 N.
TEST(VirtualCoupling, TheDevicesSideDampsTheHandsMotion) {
  scene::Hands h = two_sided();
  h.device_N_s_per_m = 0.5;
  EXPECT_NEAR(felt(h, {true, Vec3::Zero(), Vec3::Zero()}, Vec3::Zero(), Vec3(2, 0, 0)).x(), -0.1 / 3.0, 1e-9);
}

TEST(VirtualCoupling, TheHandFeelsWhatTheThreadFeelsScaled) {  // the springs in series carry the same force
  const scene::Hands h = two_sided();
  const VirtualCoupling coupling(h, kT_s);
  const Grasp grasp{true, Vec3(0.02, -0.05, 0.1), Vec3::Zero()};
  Proxy proxy;
  Vec3 f;
  for (int i = 0; i < 2000; ++i) f = coupling.pull(grasp, Vec3::Zero(), Vec3::Zero(), proxy).f_N;
  const Vec3 thread_N = h.coupling_N_per_m * (grasp.p_WG - proxy.p_WP);
  EXPECT_LT((f - h.force_scale * thread_N).norm(), 1e-12);
}

TEST(VirtualCoupling, ALooseProxyIsTheDevice) {
  const VirtualCoupling coupling(two_sided(), kT_s);
  Proxy proxy{Vec3(9, 9, 9), Vec3::Zero()};
  static_cast<void>(coupling.pull({}, Vec3(1, 2, 3), Vec3(4, 5, 6), proxy));
  EXPECT_EQ(proxy.p_WP, Vec3(1, 2, 3));
  EXPECT_EQ(proxy.v_WP, Vec3(4, 5, 6));
}

TEST(VirtualCoupling, TellsWhatIsNoNumber) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const auto& h : {hands(), two_sided()}) {
    Proxy proxy;
    const auto pull =
        VirtualCoupling(h, kT_s).pull({true, Vec3(nan, 0, 0), Vec3::Zero()}, Vec3::Zero(), Vec3::Zero(), proxy);
    EXPECT_FALSE(pull.finite);
    EXPECT_EQ(pull.f_N, Vec3::Zero());
    EXPECT_TRUE(proxy.p_WP.allFinite());
  }
}

TEST(Admissible, IsTheBoundOfTheDevice) {  // dampings 0.3 and 0.36 N s/m, half a period + delay = 1.5 ms: 440 N/m
  scene::Hands h = hands();
  h.workspace_scale = 20.0;
  const Admissible a = admissible(h, device::omni(), kT_s);
  EXPECT_NEAR(a.K_N_per_m, 72.0, 1e-12);
  EXPECT_NEAR(a.largest_N_per_m, (0.3 + 0.36) / 1.5e-3, 1e-9);
  EXPECT_TRUE(a.holds());
  h.coupling_N_per_m = 8000.0;
  EXPECT_FALSE(admissible(h, device::omni(), kT_s).holds());
}

// In series each side's damping counts by the square of the other side's share of the stiffness:
// B = (B_d K_t^2 + B_t K_d^2) / (K_d + K_t)^2, here (2 x 72^2 + 0.36 x 36^2) / 108^2 = 0.929 N s/m
TEST(Admissible, ASofterSideCountsWithItsOwnDamping) {
  scene::Hands h = two_sided();
  h.device_N_s_per_m = 2.0;
  const Admissible a = admissible(h, device::omni(), kT_s);
  EXPECT_NEAR(a.K_N_per_m, 24.0, 1e-12);
  EXPECT_NEAR(a.largest_N_per_m, (0.3 + (2.0 * 72.0 * 72.0 + 0.36 * 36.0 * 36.0) / (108.0 * 108.0)) / 1.5e-3, 1e-6);
}

TEST(Admissible, ShippedScenesHold) {
  for (const char* file : {"paper.toml", "desk.toml", "suture-3-0.toml", "suture-3-0-knot.toml"}) {
    const auto scene = scene::load_scene(std::string(LIGATURE_SOURCE_DIR) + "/scenes/" + file);
    const Admissible a = admissible(std::get<scene::Scene>(scene).hands, device::omni(), kT_s);
    EXPECT_TRUE(a.holds()) << file << ": " << a.K_N_per_m << " N/m, largest " << a.largest_N_per_m;
  }
}

TEST(Saturate, LimitsEvenTheLargestNumbers) {
  const auto f = saturate(Vec3(1e308, 1e308, 0), 3.3);
  EXPECT_TRUE(f.limited && f.finite);
  EXPECT_NEAR(f.f_N.norm(), 3.3, 1e-12);
}

TEST(Saturate, TurnsWhatIsNoNumberIntoZeroAndTells) {
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    const auto f = saturate(Vec3(bad, 0, 0), 3.3);
    EXPECT_FALSE(f.finite);
    EXPECT_EQ(f.f_N, Vec3::Zero());
  }
}

TEST(WorkspaceMap, HomeIsTheOriginAndLengthsScale) {
  scene::Hands h = hands();
  h.workspace_scale = 20.0;
  h.workspace_origin_m = {0.5, -0.4, 3.2};
  const Vec3 home(0.0, -0.17, 0.0);
  const WorkspaceMap map(h, home);
  EXPECT_LT((map.position(home) - Vec3(0.5, -0.4, 3.2)).norm(), 1e-12);
  EXPECT_LT((map.position(home + Vec3(0.01, 0, 0)) - Vec3(0.7, -0.4, 3.2)).norm(), 1e-12);
  EXPECT_LT((map.velocity(Vec3(0, 0.1, 0)) - Vec3(0, 2, 0)).norm(), 1e-12);
}

}  // namespace
}  // namespace ligature::control
