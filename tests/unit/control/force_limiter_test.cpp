// ForceLimiter: every limit (peak, continuous, step) holds for any requested force.
#include "firmware/control/force_limiter.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <deque>

#include "tests/support/random.hpp"
#include "tests/unit/control/plain_device.hpp"

namespace ligature::control {
namespace {

using physics::Vec3;

ForceLimiter limiter(double max_force_N = 3.3) { return {device::omni(), max_force_N, kT_s}; }

Vec3 send(ForceLimiter& l, const Vec3& wish) {
  const Vec3 f = l.limit(wish);
  l.sent(f);
  return f;
}

/// Requested forces that jump, rest, oscillate and diverge, for some minutes.
struct Wishes {
  test::Random random{17};
  double any() { return random.normal(); }
  double share() { return random.share(); }
  Vec3 now = Vec3::Zero();
  Vec3 next() {
    const double dice = share();
    if (dice < 0.02) {
      now = Vec3{any(), any(), any()};
      now *= std::pow(10.0, 3.0 * share() - 1.0);
    }
    if (dice > 0.98) now = Vec3::Zero();
    if (dice > 0.5 && dice < 0.6) now += 0.1 * Vec3{any(), any(), any()};
    return now;
  }
};

TEST(ForceLimiter, NoWishLeadsBeyondAnyLimit) {
  const auto d = device::omni();
  ForceLimiter l = limiter(3.0);
  Wishes wishes;
  Vec3 before = Vec3::Zero();
  std::deque<double> changes;
  double over_100_ms = 0.0, hottest = 0.0;
  int seen = 0;
  for (int i = 0; i < 300'000; ++i) {
    const Vec3 f = send(l, wishes.next());
    const double change = (f - before).norm();
    before = f;
    ASSERT_LE(f.norm(), 3.0) << i;
    ASSERT_LE(change, d.force_step_N) << i;
    changes.push_back(change);
    over_100_ms += change;
    if (changes.size() > 100) over_100_ms -= changes.front(), changes.pop_front();
    ASSERT_LE(over_100_ms, d.force_step_N + 0.1 * d.force_slew_N_per_s + 1e-9) << i;
    hottest = std::max(hottest, l.heat());
    seen |= l.codes();
  }
  EXPECT_LE(hottest, 1.4);
  EXPECT_EQ(seen, rt::kPeakLimit | rt::kContinuousLimit | rt::kStepLimit | rt::kSlewLimit);
}

TEST(ForceLimiter, LeavesAloneWhatIsAllowed) {
  ForceLimiter l = limiter();
  for (int i = 0; i < 20'000; ++i) {
    const Vec3 wish(0.3 * std::sin(0.01 * i), 0.2, 0.0);
    const Vec3 f = send(l, wish);
    if (i <= 2) continue;  // limited by the first step
    ASSERT_EQ(f, wish) << i;
    ASSERT_EQ(l.codes(), 0) << i;
  }
}

TEST(ForceLimiter, PeakForAWhileThenTheContinuousForce) {
  ForceLimiter l = limiter();
  int peak_ms = 0;
  for (int i = 0; i < 10'000; ++i) peak_ms += send(l, Vec3(0, 0, 50)).norm() > 3.29;
  // 3.3 N are 3.75 times the continuous force: heating by 3.75^2 = 14.06, the heat reaches 1 after (thermal time
  // constant) x ln(14.06 / 13.06) = 0.74 s.
  EXPECT_GT(peak_ms, 500);
  EXPECT_LT(peak_ms, 1000);
  EXPECT_NEAR(send(l, Vec3(0, 0, 50)).norm(), 0.88, 1e-9);
  EXPECT_TRUE(l.codes() & rt::kContinuousLimit);
}

TEST(ForceLimiter, ComesBackByHysteresisAndOnlyOnce) {
  ForceLimiter l = limiter();
  for (int i = 0; i < 5'000; ++i) send(l, Vec3(0, 0, 3.3));
  int changes = 0;
  bool limited = true;
  for (int i = 0; i < 20'000; ++i) {
    send(l, Vec3(0, 0, 0.5));
    const bool now = l.cap_N() < 3.2;
    changes += now != limited;
    limited = now;
  }
  EXPECT_EQ(changes, 1);
  EXPECT_FALSE(limited);
}

// Hysteresis: peak forces are allowed again when the heat is below 0.7. At a steady 0.8 N the heat falls only to 0.83.
TEST(ForceLimiter, AWindingThatHasHardlyCooledGivesNoPeak) {
  ForceLimiter l = limiter();
  for (int i = 0; i < 10'000; ++i) (void)send(l, Vec3(0, 0, 50));
  for (int i = 0; i < 60'000; ++i) (void)send(l, Vec3(0, 0, 0.8));
  EXPECT_LT(l.heat(), 0.9);
  for (int i = 0; i < 500; ++i) EXPECT_LE(send(l, Vec3(0, 0, 50)).norm(), 0.88 + 1e-9);
}

TEST(ForceLimiter, TheContinuousForceIsNeverTakenAway) {
  ForceLimiter l = limiter();
  for (int i = 0; i < 100'000; ++i) {
    const double f = send(l, Vec3(0, 0.87, 0)).norm();
    if (i > 10) {
      ASSERT_DOUBLE_EQ(f, 0.87);
    }
  }
}

}  // namespace
}  // namespace ligature::control
