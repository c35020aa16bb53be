// The filter's noise and lag, as its docstring states them.
#include "firmware/control/velocity_filter.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace ligature::control {
namespace {

constexpr double kT_s = 1e-3;
using physics::Vec3;

TEST(VelocityFilter, FirstSampleIsRest) {
  VelocityFilter filter(kT_s);
  filter.add(Vec3(5, 6, 7), 1);
  EXPECT_EQ(filter.velocity_m_per_s(), Vec3::Zero());
}

TEST(VelocityFilter, LagsARampByFourMilliseconds) {  // v(t) = t: the filter shows v(t - lag), in steady state
  VelocityFilter filter(kT_s);
  double t = 0.0;
  for (int i = 0; i < 500; ++i, t += kT_s) filter.add(Vec3(0.5 * t * t, 0, 0), 1);
  const double now = t - kT_s;
  const double lag = now - 0.5 * kT_s - filter.velocity_m_per_s().x();  // the difference itself lags half a period
  EXPECT_NEAR(lag, (1.0 - VelocityFilter::kGain) / VelocityFilter::kGain * kT_s, 1e-9);
}

TEST(VelocityFilter, NoiseOfQuantisedPositionsIsAsStated) {  // 60000 samples: the deviation is good to 1 %
  constexpr double kStep_m = 0.051e-3;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> error(-kStep_m / 2, kStep_m / 2);
  VelocityFilter filter(kT_s);
  double squares = 0.0;
  constexpr int kCount = 60000;
  for (int i = 0; i < kCount; ++i) {
    filter.add(Vec3(error(random), 0, 0), 1);
    squares += std::pow(filter.velocity_m_per_s().x(), 2);
  }
  const double a = VelocityFilter::kGain;
  const double stated = kStep_m / (kT_s * std::sqrt(12.0)) * a * std::sqrt(2.0 / (2.0 - a));
  EXPECT_NEAR(std::sqrt(squares / kCount), stated, 0.03 * stated);
  EXPECT_NEAR(stated, 0.0031, 0.0001);
}

TEST(VelocityFilter, MissingSamplesDoNotShakeAConstantVelocity) {
  VelocityFilter filter(kT_s);
  for (int i = 0; i < 100; ++i) filter.add(Vec3(0.3 * kT_s * i, 0, 0), 1);
  filter.add(Vec3(0.3 * kT_s * 106, 0, 0), 7);
  EXPECT_NEAR(filter.velocity_m_per_s().x(), 0.3, 1e-9);
  filter.add(Vec3(9, 9, 9), 0);  // no time passed: nothing learned
  EXPECT_NEAR(filter.velocity_m_per_s().x(), 0.3, 1e-9);
}

}  // namespace
}  // namespace ligature::control
