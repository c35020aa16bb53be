// Motions planned in the loop end when predicted, never jump, and allocate nothing.
#include "firmware/control/motion.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <new>

#include "firmware/platform/sanitized.hpp"

namespace {
long allocations = 0;
}  // namespace

#ifndef LIGATURE_SANITIZED  // sanitizers bring their own; there nothing is counted
// Not inlined: GCC 14 takes free() for a wrong partner of an operator new that it has not inlined.
void* operator new(std::size_t size) {
  ++allocations;
  if (void* p = std::malloc(size)) return p;
  throw std::bad_alloc();
}
[[gnu::noinline]] void operator delete(void* p) noexcept { std::free(p); }
[[gnu::noinline]] void operator delete(void* p, std::size_t) noexcept { std::free(p); }
#endif

namespace ligature::control {
namespace {

TEST(Ramp, TakesItsDurationAndIsSmooth) {
  Ramp ramp(1e-3);
  double before = 0.0, speed = 0.0, rise = 0.0;
  for (int i = 0; i < 500; ++i) {
    EXPECT_LT(before, 1.0) << i;
    const double now = ramp.step(1.0, 0.5);
    EXPECT_GT(now, before) << i;
    EXPECT_LE(std::abs((now - before) - speed), 6.0 / 0.25 * 1e-6 + 1e-12) << i;  // bound on the acceleration times T^2
    EXPECT_LE(std::abs(now - before - speed - rise), 72.0 / 0.125 * 1e-9 + 1e-12) << i;  // bound on the jerk times T^3
    rise = now - before - speed;
    speed = now - before;
    before = now;
  }
  EXPECT_EQ(before, 1.0);
}

TEST(Ramp, TurnsRoundWithoutAJump) {
  Ramp ramp(1e-3);
  double before = 0.0;
  for (int i = 0; i < 2000; ++i) {
    const bool up = (i / 130) % 2 == 0;
    const double now = ramp.step(up ? 1.0 : 0.0, up ? 0.5 : 0.05);
    EXPECT_LE(std::abs(now - before), 1.5 / 0.05 * 1e-3 + 1e-9) << i;
    EXPECT_GE(now, 0.0);
    EXPECT_LE(now, 1.0);
    before = now;
  }
}

/// Largest acceleration and jerk of a sampled path, over all axes.
struct Watch {
  physics::Vec3 speed, push = physics::Vec3::Zero();
  double acceleration = 0.0, jerk = 0.0;
  explicit Watch(const physics::Vec3& at_first) : speed(at_first) {}
  void see(const physics::Vec3& now) {
    const physics::Vec3 a = (now - speed) / 1e-3;
    acceleration = std::max(acceleration, a.cwiseAbs().maxCoeff());
    jerk = std::max(jerk, (a - push).cwiseAbs().maxCoeff() / 1e-3);
    push = a;
    speed = now;
  }
};
constexpr double kSlack = 1.0 + 1e-6;

TEST(BrakeToRest, StopsFromAnySpeedWithinItsLimits) {
  BrakeToRest brake(1e-3);
  brake.start({0.1, 0.2, 0.3}, {2.0, -1.0, 0.5});
  EXPECT_EQ(brake.position_m(), physics::Vec3(0.1, 0.2, 0.3));  // starts at the tip's position and velocity
  EXPECT_EQ(brake.velocity_m_per_s(), physics::Vec3(2.0, -1.0, 0.5));
  Watch watch(brake.velocity_m_per_s());
  physics::Vec3 went = physics::Vec3::Zero();
  int moving = 0;
  for (int i = 0; i < 300; ++i) {
    const physics::Vec3 before = brake.velocity_m_per_s();
    brake.step();
    watch.see(brake.velocity_m_per_s());
    went += 0.5e-3 * (before + brake.velocity_m_per_s());
    moving += brake.velocity_m_per_s().norm() > 1e-9;
  }
  EXPECT_LE(watch.acceleration, BrakeToRest::kDeceleration_m_per_s2 * kSlack);
  EXPECT_LE(watch.jerk, BrakeToRest::kJerk_m_per_s3 * kSlack);
  EXPECT_LT(brake.velocity_m_per_s().norm(), 1e-9);
  EXPECT_LT((brake.position_m() - physics::Vec3(0.1, 0.2, 0.3) - went).norm(), 1e-4);
  EXPECT_LT(moving, 60);
}

TEST(GuidedMove, GoesStraightWithinItsLimitsAndStops) {
  GuidedMove move(1e-3);
  const physics::Vec3 from(0.01, -0.17, 0.03), to(-0.05, -0.2, 0.0);
  ASSERT_TRUE(move.start(from, to));
  physics::Vec3 before = from;
  Watch watch(physics::Vec3::Zero());
  int ticks = 0;
  for (; !move.is_done(); ++ticks) {
    ASSERT_LT(ticks, 5000);
    move.step();
    const physics::Vec3 way = (to - from).normalized(), off = move.position_m() - from;
    EXPECT_LT((off - way * way.dot(off)).norm(), 1e-9) << ticks;
    watch.see(move.velocity_m_per_s());
    EXPECT_LE(move.velocity_m_per_s().cwiseAbs().maxCoeff(), GuidedMove::kSpeed_m_per_s + 1e-9);
    before = move.position_m();
  }
  EXPECT_LE(watch.acceleration, GuidedMove::kAcceleration_m_per_s2 * kSlack);
  EXPECT_LE(watch.jerk, GuidedMove::kJerk_m_per_s3 * kSlack);
  EXPECT_GT(ticks, 500);
  EXPECT_LT((before - to).norm(), 1e-6);
}

TEST(Motion, PlansWithoutAllocating) {
  GuidedMove move(1e-3);
  Ramp ramp(1e-3);
  BrakeToRest brake(1e-3);
  const long before = allocations;
  for (int i = 0; i < 3000; ++i) {
    static_cast<void>(ramp.step((i / 70) % 2 == 0 ? 1.0 : 0.0, 0.5));
    if (i % 50 == 0) brake.start({0, 0, 0}, {std::sin(0.1 * i), 1.0, -2.0});
    brake.step();
    if (i % 90 == 0) static_cast<void>(move.start({0, 0, 0}, {0.1 * std::sin(0.1 * i), 0.1, -0.05}));
    move.step();
  }
  EXPECT_EQ(allocations, before);
}

}  // namespace
}  // namespace ligature::control
