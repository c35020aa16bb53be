// WindowVelocity estimates a velocity from encoder counts: its noise and lag, compared with a first-order low-pass.
// Prints the tables of docs/measurements/haptics.md.
#include "firmware/control/window_velocity.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "tests/unit/control/plain_device.hpp"

namespace ligature::control {
namespace {

constexpr double kQuantum_rad = 2.0 * std::numbers::pi / 16384.0;
constexpr double kLever_m = 0.1325;  // m; tip speeds below are for a link of this length

/// The low-pass: v += 0.2 (backward difference - v).
struct LowPass {
  void add(double x, std::int64_t) {
    if (seeded) v += 0.2 * ((x - last) / kT_s - v);
    seeded = true;
    last = x;
  }
  [[nodiscard]] double velocity_per_s() const { return v; }
  bool seeded = false;
  double last = 0.0, v = 0.0;
};

struct Error {
  double rms_m_per_s, mean_m_per_s;
};

/// Error of the tip's velocity for a joint motion x(t), v(t) read in whole counts; the first 100 ms are left out.
template <class Estimator>
Error run(Estimator estimator, const std::function<double(double)>& x, const std::function<double(double)>& v) {
  double squares = 0.0, sum = 0.0;
  int n = 0;
  for (int i = 0; i < 4000; ++i) {
    const double t = i * kT_s;
    estimator.add(std::round(x(t) / kQuantum_rad) * kQuantum_rad, i == 0 ? 0 : 1);
    if (i < 100) continue;
    const double e = (estimator.velocity_per_s() - v(t)) * kLever_m;
    squares += e * e;
    sum += e;
    ++n;
  }
  return {std::sqrt(squares / n), sum / n};
}

WindowVelocity window() { return {kT_s, kQuantum_rad}; }

TEST(WindowVelocity, ConstantSpeedsAreLessNoisyThanTheLowPass) {
  for (const double speed : {0.001, 0.01, 0.05, 0.2, 0.5}) {
    const double rate = speed / kLever_m * 1.0137;  // not a whole number of counts per period
    const auto x = [&](double t) { return rate * t; };
    const auto v = [&](double) { return rate; };
    const Error now = run(window(), x, v), before = run(LowPass{}, x, v);
    std::printf("noise at %.3f m/s: window %.2f mm/s rms, low-pass %.2f mm/s rms\n", speed, 1e3 * now.rms_m_per_s,
                1e3 * before.rms_m_per_s);
    EXPECT_LT(now.rms_m_per_s, 0.85 * before.rms_m_per_s) << speed;
    EXPECT_LT(now.rms_m_per_s, 0.0025) << speed;
    EXPECT_LT(std::abs(now.mean_m_per_s), 2e-4) << speed;
  }
}

TEST(WindowVelocity, LagsLessThanTheLowPassWhenItMatters) {  // at steady acceleration: lag = -mean error / acceleration
  for (const double a : {5.0, 10.0, 50.0}) {                 // m/s^2 at the tip
    const double rate = a / kLever_m;
    const auto lag_ms = [&](auto estimator) {
      double sum = 0.0;
      int n = 0;
      for (int i = 0; i < 200; ++i) {
        const double t = i * kT_s;
        estimator.add(std::round(0.5 * rate * t * t / kQuantum_rad) * kQuantum_rad, i == 0 ? 0 : 1);
        if (i >= 60) sum += rate * t - estimator.velocity_per_s(), ++n;
      }
      return 1e3 * sum / n / rate;
    };
    const double now = lag_ms(window()), before = lag_ms(LowPass{});
    std::printf("lag at %.0f m/s^2: window %.2f ms, low-pass %.2f ms\n", a, now, before);
    EXPECT_LT(now, before) << a;
  }
}

TEST(WindowVelocity, AtRestAFlickeringCountIsHardlySeen) {  // worst case: the count flips every period
  WindowVelocity estimator = window();
  double most = 0.0;
  for (int i = 0; i < 200; ++i) {
    estimator.add((i % 2) * kQuantum_rad, 1);
    if (i > 25) most = std::max(most, std::abs(estimator.velocity_per_s()) * kLever_m);
  }
  EXPECT_LT(most, 0.001);  // the low-pass gives 0.0056
}

TEST(WindowVelocity, FirstSampleIsRestAndNoTimeTeachesNothing) {
  WindowVelocity estimator = window();
  estimator.add(5.0, 0);
  EXPECT_EQ(estimator.velocity_per_s(), 0.0);
  estimator.add(9.0, 0);
  EXPECT_EQ(estimator.velocity_per_s(), 0.0);
}

TEST(WindowVelocity, AJumpIsSeenAtOnce) {
  WindowVelocity estimator = window();
  for (int i = 0; i < 50; ++i) estimator.add(0.0, 1);
  estimator.add(0.1, 1);
  EXPECT_NEAR(estimator.velocity_per_s(), 100.0, 1e-9);
  EXPECT_EQ(estimator.window(), 1U);
}

TEST(WindowVelocity, MissingSamplesDoNotShakeAConstantVelocity) {
  WindowVelocity estimator = window();
  std::int64_t at = 0;
  for (int i = 0; i < 100; ++i, ++at) estimator.add(0.3 * kT_s * static_cast<double>(at), 1);
  at += 6;
  estimator.add(0.3 * kT_s * static_cast<double>(at), 7);
  EXPECT_NEAR(estimator.velocity_per_s(), 0.3, 1e-9);
  estimator.add(7.0, 100);  // after so long a gap the estimator restarts
  EXPECT_EQ(estimator.velocity_per_s(), 0.0);
}

}  // namespace
}  // namespace ligature::control
