// The energy account of a hand with a simulated plant: it is exact, and no hand within the acceleration bound overdraws
// it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "tests/support/random.hpp"
#include "tests/unit/control/passivity_port.hpp"

namespace ligature::control {
namespace {

TEST(Passivity, TheAccountIsTheWorkToTheLastDigit) {  // against the work that the plant itself sums
  Port port(false);
  for (int i = 0; i < 3000; ++i) port.tick(spring, 10.0 * Vec3(std::cos(0.02 * i), std::sin(0.03 * i), 0));
  const double before = port.work_J;
  port.tick(spring, Vec3::Zero());
  EXPECT_NEAR(port.passivity.energy_J(), before, 1e-12);
}

// Sampling delays a spring's force, so in each full oscillation the hand would get more energy than it gives.
TEST(Passivity, ASampledSpringMakesEnergyAndTheControllerRefusesIt) {
  const auto swing = [](bool active) {
    Port port(active);
    port.v.x() = 0.02 * 40.0;  // amplitude 2 cm at 40 rad/s
    for (int i = 0; i < 2000; ++i) port.tick(spring, Vec3(-0.02 * 40.0 * 40.0 * std::sin(0.04 * (i + 0.5)), 0, 0));
    return port;
  };
  EXPECT_LT(swing(false).lowest_J, -1e-4);
  const Port held = swing(true);
  EXPECT_GE(held.lowest_J, -Passivity::kFloor_J);
  EXPECT_GT(held.acted, 0);
}

/// 40 random attacks of 3 s. In each period the hand's acceleration is drawn anew, up to the bound `a` in both senses:
/// in half of the attacks along the motors' force, in the others along a direction that changes every 1 to 17 periods.
/// The motors act as a damped spring, or in every third attack as a negative spring, which pushes outwards.
/// @param wildness `a` as a share of the device's acceleration bound
/// @param look is called with the port after each attack
template <class Look>
void play_adversaries(const Chain& chain, Look look, double wildness = 1.0, bool active = true) {
  test::Random random(5);
  const auto share = [&] { return random.in(-1.0, 1.0); };
  const auto any = [&] { return random.normal(); };
  const double a = wildness * plain().hand_acceleration_m_per_s2;
  for (int seed = 0; seed < 40; ++seed) {
    Chain own = chain;
    own.wildness = wildness, own.seed += static_cast<std::uint64_t>(seed);
    Port port(active, 0.0, own);
    Vec3 push = Vec3::Zero();
    for (int i = 0; i < 3000; ++i) {
      if (i % (1 + seed % 17) == 0) push = Vec3{any(), any(), any()}.normalized();
      const bool with_the_force = seed % 2 == 0 && !port.made.isZero();
      Vec3 acceleration = a * (with_the_force ? Vec3(port.made.normalized()) : push) * share();
      if (port.v.norm() > 1.0) acceleration = -a * port.v.normalized();
      const double gain = seed % 3 == 0 ? 400.0 : -400.0;  // positive: pushes outwards like a motor; negative: a spring
      const auto law = [gain](const Vec3& p, const Vec3& v) { return saturated(gain * p + 0.5 * gain * 0.01 * v); };
      port.tick(law, acceleration);
    }
    SCOPED_TRACE(seed);
    look(port);
  }
}

TEST(Passivity, NoHandWithinTheBoundOverdrawsTheAccount) {
  play_adversaries({}, [](const Port& port) { EXPECT_GE(port.lowest_J, -Passivity::kFloor_J); });
}

/// The force changes by at most the step limit per tick, except where the whole force is dropped for lack of energy.
/// How often that happens depends on the random draw; here it is rare.
TEST(Passivity, HandsWithinTheBoundAreCutByAStepButWhereTheyAreLetGo) {
  double felt_N = 0.0;
  int let_go = 0;
  const auto look = [&](const Port& port) {
    EXPECT_LE(port.largest_step_N, plain().force_step_N * (1.0 + 1e-9));
    let_go += port.released > 0;
    felt_N = std::max(felt_N, port.made.norm());
  };
  play_adversaries({}, look);
  // One count of 0.05 mm in a period of 1 ms looks like 50 m/s2, half of the bound.
  play_adversaries({.count_m = 5e-5}, look, 0.4);
  EXPECT_GT(felt_N, 0.5);
  EXPECT_LE(let_go, 6) << "of 80";
}

// The force that the drives really make changes by at most the step limit per tick, except where the whole force is
// dropped for lack of energy.
TEST(Passivity, WhatTheDrivesMakeChangesByAStepWhateverIsLost) {
  const Chain whole{}, lossy{.lost = 0.05}, very{.lost = 0.3}, blind{.lost_samples = 0.14};
  const Chain both{.lost = 0.05, .lost_samples = 0.14}, silent{.lost = 0.05, .tells_torque = false};
  for (const Chain& chain : {whole, lossy, very, blind, both, silent}) {
    for (const double wildness : {0.5, 4.0}) {
      SCOPED_TRACE(::testing::Message() << "lost " << chain.lost << " and " << chain.lost_samples);
      int released = 0;
      const auto look = [&](const Port& port) {
        EXPECT_LE(port.largest_made_step_N, plain().force_step_N * (1.0 + 1e-9));
        released += port.released;
      };
      play_adversaries(chain, look, wildness);
      std::printf("RPDOs %.2f, samples %.2f lost, %.1f of the wildest hand: let go %d times in 120 s\n", chain.lost,
                  chain.lost_samples, wildness, released);
    }
  }
}

// With rounded positions the account may be wrong by one count per joint at each change of force.
TEST(Passivity, OnCountsTheTrueWorkIsWithinItsBounds) {
  double lowest_J = 0.0, most_hidden_J = 0.0;
  play_adversaries({.count_m = 5e-5}, [&](const Port& port) {
    EXPECT_LE(port.bounds.above_J, kExact_J);
    EXPECT_LE(port.bounds.work_below_J, kExact_J);
    lowest_J = std::min(lowest_J, port.lowest_work_J);
    most_hidden_J = std::max(most_hidden_J, port.bounds.hidden_J());
  });
  std::printf("random jerks on counts: true work %.2e J; counts may hide %.2e J\n", lowest_J, most_hidden_J);
}

TEST(Passivity, BetweenCountsASlowJointIsWhereItsSpeedSays) {  // a tenth of a count per period, under a steady torque
  Port port(false, 0.0, {.count_m = 5e-5});
  const double force_N = 0.3;
  port.v.x() = 5e-3;
  for (int i = 0; i < 1000; ++i) {
    if (i == 100) port.largest_excess_J = port.largest_shortfall_J = -1e9;  // the estimators have converged
    port.tick([&](const Vec3&, const Vec3&) { return Vec3(force_N, 0, 0); }, Vec3::Zero());
  }
  // Without interpolation between counts the hidden energy would be that of one count.
  const double hidden_J = port.largest_excess_J + port.largest_shortfall_J;
  std::printf("between counts: %.2f of a count's energy hidden\n", hidden_J / (force_N * port.chain.count_m));
  EXPECT_LT(hidden_J, 0.5 * force_N * port.chain.count_m);
}

/// The account may exceed the true work only by rounding of positions and by unknown motion between samples, whatever
/// torque the drive made of its command.
TEST(Passivity, TheAccountIsNeverAboveTheTrueWork) {
  const Chain plainly{}, counted{.count_m = 5e-5};
  const Chain guarded{.guard_N = 0.3}, silent{.guard_N = 0.3, .tells_torque = false};
  const Chain lossy{.lost = 0.05}, lossy_silent{.lost = 0.3, .tells_torque = false};
  const Chain blind{.lost_samples = 0.15}, both{.lost = 0.15, .lost_samples = 0.15};
  const Chain both_silent{.lost = 0.15, .lost_samples = 0.3, .tells_torque = false};
  for (const Chain& chain : {plainly, counted, guarded, silent, lossy, lossy_silent, blind, both, both_silent}) {
    SCOPED_TRACE(::testing::Message() << "lost " << chain.lost << " and " << chain.lost_samples);
    play_adversaries(chain, [&](const Port& port) { EXPECT_LE(port.bounds.above_J, kExact_J); });
  }
}

// When a torque message is lost, an older torque acts. The account is corrected when the drive reports which.
TEST(Passivity, ALostTorqueIsBookedToTheLastDigit) {
  for (const bool tells : {true, false}) {
    const auto look = [](const Port& port) {
      EXPECT_LE(port.largest_excess_J, 1e-10);
      EXPECT_LE(port.largest_shortfall_J, 1e-10);
    };
    // active = false: an active passivity controller gives up energy of its account after losses, so the account would
    // not be exact.
    play_adversaries({.lost = 0.3, .tells_torque = tells}, look, 1.0, false);
  }
}

TEST(Passivity, AHeldTorqueIsBookedExactlyOverLostSamples) {
  Port port(false, 0.0, {.lost_samples = 0.5});
  const auto hold = [](const Vec3&, const Vec3&) { return Vec3(0.3, 0, 0); };
  for (int i = 0; i < 500; ++i) {
    if (i == 20) port.largest_excess_J = port.largest_shortfall_J = -1e9;  // from here on the torque acts
    port.tick(hold, Vec3(std::cos(0.05 * i), 0, 0));
  }
  EXPECT_LE(port.largest_excess_J + port.largest_shortfall_J, 1e-12);
}

TEST(Passivity, LostFramesGiveNothingAwayButWhatNobodyForesaw) {
  for (const bool tells : {true, false}) {
    for (const Chain& chain : {Chain{.lost = 0.05, .tells_torque = tells},
                               {.lost_samples = 0.14, .tells_torque = tells},
                               {.lost = 0.05, .lost_samples = 0.14, .tells_torque = tells}}) {
      for (const double wildness : {0.5, 1.0}) {
        double work_J = 0.0, account_J = 0.0;
        const auto look = [&](const Port& port) {
          EXPECT_LE(port.bounds.below_J, kExact_J);
          EXPECT_LE(port.bounds.work_below_J, kExact_J);
          EXPECT_LE(port.bounds.above_ceiling_J, kExact_J);
          work_J = std::min(work_J, port.lowest_work_J), account_J = std::min(account_J, port.lowest_J);
        };
        play_adversaries(chain, look, wildness);
        std::printf("RPDOs %.2f, samples %.2f lost, %.1f of the wildest hand: work %.2e J, account %.2e J\n",
                    chain.lost, chain.lost_samples, wildness, work_J, account_J);
      }
    }
  }
}

TEST(Passivity, AMotorGetsNothingFromAHandThatNeverPaid) {  // constant force along the motion
  Port port(true);
  for (int i = 0; i < 1000; ++i) port.tick([](const Vec3&, const Vec3&) { return Vec3(1, 0, 0); }, Vec3(i < 100, 0, 0));
  EXPECT_LT(port.made.norm(), 0.01);
  EXPECT_GE(port.lowest_J, -Passivity::kFloor_J);
}

// Pull 1 cm slowly and hold: the hand feels the force whose energy it has supplied.
TEST(Passivity, APaidSpringIsFeltInFull) {
  Port port(true);
  const double rate = 2.0 * std::acos(-1.0);
  for (int i = 0; i < 2000; ++i) {
    const bool pulls = i < 500;
    port.tick(spring, Vec3(pulls ? 0.0025 * rate * rate * std::cos(rate * i * kT_s) : -50.0 * port.v.x(), 0, 0));
  }
  EXPECT_GT(port.p.norm(), 0.002);
  EXPECT_NEAR(port.made.norm(), 400.0 * port.p.norm(), 0.01 * 400.0 * port.p.norm());
}

/// A hand draws `draw_m` at 15 mm/s and rests, with quantised positions and torques. @return the share of the resting
/// time in which the hand feels at least four fifths of the spring force K x.
double felt_of_a_slow_pull(Chain chain, double draw_m) {
  chain.count_m = 5e-5;
  Port port(true, 0.0, chain);
  const double K = 1.2 / draw_m, quantum_N = 2.2e-3;
  const int moving = static_cast<int>(draw_m / 15e-6), resting = 1000;
  const auto law = [&](const Vec3& p, const Vec3&) { return Vec3(-K * std::round(p.x() / 5e-5) * 5e-5, 0, 0); };
  int felt = 0;
  double mean_N = 0.0;
  for (int i = 0; i < moving + resting; ++i) {
    port.made_of = [&](const Vec3& f) { return Vec3((f / quantum_N).array().round() * quantum_N); };
    port.tick(law, Vec3(i < 15 ? 1.0 : i >= moving && i < moving + 15 ? -1.0 : 0.0, 0, 0));
    if (i < moving) continue;
    felt += port.made.norm() >= 0.8 * K * port.p.x();
    mean_N += port.made.norm() / resting;
  }
  EXPECT_GE(port.lowest_work_J, -Passivity::kFloor_J);
  std::printf("slow pull of %.0f mm, %.2f and %.2f lost: %.3f of %.3f N, %.3f of the time\n", 1e3 * draw_m, chain.lost,
              chain.lost_samples, mean_N, K * port.p.x(), static_cast<double>(felt) / resting);
  return static_cast<double>(felt) / resting;
}

TEST(Passivity, ASlowPullOnCountsIsFelt) {  // the first torque quantum must be allowed before any energy is earned
  EXPECT_GT(felt_of_a_slow_pull({}, 0.006), 0.95);
}

TEST(Passivity, ASlowPullIsFeltThroughLostFrames) {  // 5 % of frames lost; a sample needs three frames
  for (std::uint32_t seed = 1; seed <= 5; ++seed)
    EXPECT_GT(felt_of_a_slow_pull({.lost = 0.05, .lost_samples = 0.14, .seed = seed}, 0.006), 0.90);
}

TEST(Passivity, CreditIsForgottenAboveTheWindow) {
  Port port(true);
  const auto drag = [](const Vec3&, const Vec3& v) { return saturated(-20.0 * v); };
  for (int i = 0; i < 20'000; ++i) port.tick(drag, Vec3(20.0 * std::cos(0.03 * i), 0, 0));
  EXPECT_DOUBLE_EQ(port.passivity.energy_J(), Passivity::kCredit_J);
}

}  // namespace
}  // namespace ligature::control
