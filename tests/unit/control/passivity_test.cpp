// The port's account against a plant of its own: exact, and never overdrawn by any hand within the bound.
#include "firmware/control/passivity.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "firmware/control/window_velocity.hpp"
#include "tests/support/random.hpp"
#include "tests/unit/control/plain_device.hpp"

namespace ligature::control {
namespace {

/// What lies between the controller and the motor.
struct Chain {
  double count_m = 0.0;  // of the encoders
  double lost = 0.0;     // share of the RPDOs
  double lost_samples = 0.0;
  double guard_N = 1e9;      // the drive makes no more than this
  bool tells_torque = true;  // else it tells only that it limits, and for how long it has held
  std::uint32_t seed = 2;    // of the losses; with 1 LostFramesGiveNothingAway falls to -1.2 uJ, as for 7 of 60 shifts
};

WindowVelocity velocity_of(const Chain& c) { return {kT_s, std::max(c.count_m, 1e-9)}; }

/// A mass that a hand and the motors push; `wish` is the law, the hand's force is given.
struct Port {
  explicit Port(bool active, double credit_J = 0.0, const Chain& c = {})
      : passivity(plain(), kT_s, active, credit_J), chain(c), random(c.seed) {}

  template <class Wish>
  void tick(Wish wish, const Vec3& acceleration) {
    // SYNC: the encoders are read, the drive takes what has arrived.
    const Vec3 seen = chain.count_m > 0.0 ? Vec3((p / chain.count_m).array().round() * chain.count_m) : p;
    PortSample sample{{seen.x(), seen.y(), seen.z()}, seen, chain.count_m, Vec3(1, 1, 1), {}, {}};
    if (chain.tells_torque) sample.acted.torque_Nm = made;
    sample.acted.limited.fill(made != taken);
    if (!chain.tells_torque) sample.acted.held = held;
    const bool is_seen = random.share() >= chain.lost_samples;
    passivity.begin(n);
    if (is_seen) {
      for (std::size_t j = 0; j < 3; ++j) {
        rate[j].add(sample.q_rad[j], n - last_seen);
        sample.rate_rad_per_s[static_cast<Eigen::Index>(j)] = rate[j].velocity_per_s();
      }
      last_seen = n;
      passivity.observe(n, sample);
      largest_shortfall_J = std::max(largest_shortfall_J, work_J - passivity.energy_J());
      largest_excess_J = std::max(largest_excess_J, passivity.energy_J() - work_J);
      if (hidden_J > 0.0) most_of_hidden = std::max(most_of_hidden, (passivity.energy_J() - work_J) / hidden_J);
    }
    lowest_J = std::min(lowest_J, passivity.energy_J());
    lowest_work_J = std::min(lowest_work_J, work_J);
    for (std::size_t j = 0; j < 3; ++j) {
      const bool arrives = random.share() >= chain.lost;  // each drive has its RPDO
      held[j] = arrives ? 0 : held[j] + 1;
      if (arrives) taken[static_cast<Eigen::Index>(j)] = on_its_way[static_cast<Eigen::Index>(j)];
    }
    const Vec3 made_before = made;
    made = taken.cwiseMax(-chain.guard_N).cwiseMin(chain.guard_N);
    if (n > forgiven) largest_made_step_N = std::max(largest_made_step_N, (made - made_before).norm());

    const Vec3 wished = wish(p, v), change = wished - before;
    const double step_N = plain().force_step_N;
    const Vec3 limited = before + change * std::min(1.0, step_N / std::max(change.norm(), step_N));
    const Vec3 paid = passivity.control(n, limited, v, before, made_of), f = made_of(paid);
    if (passivity.released()) ++released, forgiven = n + 20;  // all force goes; a lost RPDO delays it
    if (n > forgiven) largest_step_N = std::max(largest_step_N, (paid - before).norm());
    passivity.sent(n, f, f);
    before = paid;
    on_its_way = f;
    if (passivity.acts()) ++acted;
    const Vec3 moved = v * kT_s + 0.5 * acceleration * kT_s * kT_s;  // under a constant acceleration
    work_J -= made.dot(moved);
    hidden_J += chain.count_m * (made - made_before).lpNorm<1>();  // half a count by the encoder, half by the guess
    p += moved;
    v += acceleration * kT_s;
    ++n;
  }

  Passivity passivity;
  Chain chain;
  std::function<Vec3(const Vec3&)> made_of = [](const Vec3& f) { return f; };  // of torques that are rounded
  test::Random random;
  std::array<WindowVelocity, 3> rate{velocity_of(chain), velocity_of(chain), velocity_of(chain)};
  Vec3 p = Vec3::Zero(), v = Vec3::Zero(), before = Vec3::Zero();
  Vec3 on_its_way = Vec3::Zero(), taken = Vec3::Zero(), made = Vec3::Zero();
  double lowest_J = 0.0, work_J = 0.0, lowest_work_J = 0.0, largest_step_N = 0.0, largest_excess_J = -1e9;
  double largest_shortfall_J = -1e9, hidden_J = 0.0, most_of_hidden = 0.0;
  double largest_made_step_N = 0.0;
  int acted = 0, released = 0;
  std::array<int, 3> held{};
  std::int64_t n = 0, last_seen = 0, forgiven = -1;
};

Vec3 saturated(const Vec3& f) { return f.norm() > 3.3 ? Vec3(f * (3.3 / f.norm())) : f; }
Vec3 spring(const Vec3& p, const Vec3&) { return -400.0 * p; }

TEST(Passivity, TheAccountIsTheWorkToTheLastDigit) {  // against the work summed by the plant itself
  Port port(false);
  for (int i = 0; i < 3000; ++i) port.tick(spring, 10.0 * Vec3(std::cos(0.02 * i), std::sin(0.03 * i), 0));
  const double before = port.work_J;
  port.tick(spring, Vec3::Zero());
  EXPECT_NEAR(port.passivity.energy_J(), before, 1e-12);
}

TEST(Passivity, ASampledSpringMakesEnergyAndTheControllerRefusesIt) {  // a full swing costs the hand less than it gets
  const auto swing = [](bool active) {
    Port port(active);
    port.v.x() = 0.02 * 40.0;  // 2 cm at 40 rad/s
    for (int i = 0; i < 2000; ++i) port.tick(spring, Vec3(-0.02 * 40.0 * 40.0 * std::sin(0.04 * (i + 0.5)), 0, 0));
    return port;
  };
  EXPECT_LT(swing(false).lowest_J, -1e-4);
  const Port held = swing(true);
  EXPECT_GE(held.lowest_J, -Passivity::kFloor_J);
  EXPECT_GT(held.acted, 0);
}

/// 40 adversaries: jerks at full acceleration, half of them always along the motors' force; springs, and motors.
/// @param wildness share of the acceleration that the controller keeps room for
template <class Look>
void play_adversaries(const Chain& chain, Look look, double wildness = 1.0, bool active = true) {
  test::Random random(5);
  const auto share = [&] { return random.in(-1.0, 1.0); };
  const auto any = [&] { return random.normal(); };
  const double a = wildness * plain().hand_acceleration_m_per_s2;
  for (int seed = 0; seed < 40; ++seed) {
    Port port(active, 0.0, chain);
    Vec3 push = Vec3::Zero();
    for (int i = 0; i < 3000; ++i) {
      if (i % (1 + seed % 17) == 0) push = Vec3{any(), any(), any()}.normalized();
      const bool with_the_force = seed % 2 == 0 && !port.made.isZero();
      Vec3 acceleration = a * (with_the_force ? Vec3(port.made.normalized()) : push) * share();
      if (port.v.norm() > 1.0) acceleration = -a * port.v.normalized();
      const double gain = seed % 3 == 0 ? 400.0 : -400.0;  // a negative spring is a motor
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

TEST(Passivity, NoHandWithinTheBoundIsCutByMoreThanAStep) {
  double felt_N = 0.0;
  const auto look = [&](const Port& port) {
    EXPECT_LE(port.largest_step_N, plain().force_step_N * (1.0 + 1e-9));
    EXPECT_EQ(port.released, 0);
    felt_N = std::max(felt_N, port.made.norm());
  };
  play_adversaries({}, look);
  play_adversaries({.count_m = 5e-5}, look, 0.4);  // a count within a period looks like 50 m/s2
  EXPECT_GT(felt_N, 0.5);
}

TEST(Passivity, WhatTheDrivesMakeChangesByAStepWhateverIsLost) {  // but where all is let go, for energy's sake
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

TEST(Passivity, OnCountsTheAccountHoldsAndTheTrueWorkIsNear) {  // near: what counts hide at each change of force
  double lowest_J = 0.0, most_of_bound = 0.0;
  play_adversaries({.count_m = 5e-5}, [&](const Port& port) {
    EXPECT_GE(port.lowest_J, -Passivity::kFloor_J);
    EXPECT_LE(port.most_of_hidden, 1.0);
    lowest_J = std::min(lowest_J, port.lowest_work_J);
    most_of_bound = std::max(most_of_bound, port.most_of_hidden);
  });
  std::printf("random jerks on counts: true work %.2e J, up to %.2f of what counts can hide\n", lowest_J,
              most_of_bound);
  EXPECT_GE(lowest_J, -5e-4);
}

TEST(Passivity, BetweenCountsASlowJointIsWhereItsSpeedSays) {  // a tenth of a count a period, under a steady torque
  Port port(false, 0.0, {.count_m = 5e-5});
  const double force_N = 0.3;
  port.v.x() = 5e-3;
  for (int i = 0; i < 1000; ++i) {
    if (i == 100) port.largest_excess_J = port.largest_shortfall_J = -1e9;  // the estimators have settled
    port.tick([&](const Vec3&, const Vec3&) { return Vec3(force_N, 0, 0); }, Vec3::Zero());
  }
  const double hidden_J = port.largest_excess_J + port.largest_shortfall_J;  // a count's worth without the guess
  std::printf("between counts: %.2f of a count's energy hidden\n", hidden_J / (force_N * port.chain.count_m));
  EXPECT_LT(hidden_J, 0.5 * force_N * port.chain.count_m);
}

TEST(Passivity, TheAccountIsNeverAboveTheTrueWork) {  // but for a count; whatever the drive made of what it was sent
  const Chain plainly{}, counted{.count_m = 5e-5};
  const Chain guarded{.guard_N = 0.3}, silent{.guard_N = 0.3, .tells_torque = false};
  const Chain lossy{.lost = 0.05}, lossy_silent{.lost = 0.3, .tells_torque = false};
  const Chain blind{.lost_samples = 0.15}, both{.lost = 0.15, .lost_samples = 0.15};
  const Chain both_silent{.lost = 0.15, .lost_samples = 0.3, .tells_torque = false};
  for (const Chain& chain : {plainly, counted, guarded, silent, lossy, lossy_silent, blind, both, both_silent}) {
    SCOPED_TRACE(::testing::Message() << "lost " << chain.lost << " and " << chain.lost_samples);
    // Nobody saw when within two periods a joint moved: a step of force times half of a T^2, on three axes.
    const double out_of_order_J = chain.lost_samples > 0.0 ? std::sqrt(3.0) * 0.5 * 0.05e-3 : 1e-12;
    play_adversaries(chain, [&](const Port& port) {
      EXPECT_LE(port.largest_excess_J, out_of_order_J + 5.0 * chain.count_m * 3.3 * std::sqrt(3.0));
    });
  }
}

TEST(Passivity, ALostTorqueIsBookedToTheLastDigit) {  // what the drive made instead is known as soon as it tells
  for (const bool tells : {true, false}) {
    const auto look = [](const Port& port) {
      EXPECT_LE(port.largest_excess_J, 1e-10);
      EXPECT_LE(port.largest_shortfall_J, 1e-10);
    };
    play_adversaries({.lost = 0.3, .tells_torque = tells}, look, 1.0, false);  // on, it forgets credit
  }
}

TEST(Passivity, AHeldTorqueIsBookedExactlyOverLostSamples) {
  Port port(false, 0.0, {.lost_samples = 0.5});
  const auto hold = [](const Vec3&, const Vec3&) { return Vec3(0.3, 0, 0); };
  for (int i = 0; i < 500; ++i) {
    if (i == 20) port.largest_excess_J = port.largest_shortfall_J = -1e9;  // it acts by now
    port.tick(hold, Vec3(std::cos(0.05 * i), 0, 0));
  }
  EXPECT_LE(port.largest_excess_J + port.largest_shortfall_J, 1e-12);
}

struct Least {
  double work_J = 0.0, account_J = 0.0;
};

/// Of 40 adversaries with frames lost either way.
Least least_of(const Chain& chain, double wildness) {
  Least least;
  const auto look = [&](const Port& port) {
    least.work_J = std::min(least.work_J, port.lowest_work_J);
    least.account_J = std::min(least.account_J, port.lowest_J);
  };
  play_adversaries(chain, look, wildness);
  std::printf("RPDOs %.2f, samples %.2f lost, %.1f of the wildest hand: work %.2e J, account %.2e J\n", chain.lost,
              chain.lost_samples, wildness, least.work_J, least.account_J);
  return least;
}

TEST(Passivity, LostFramesGiveNothingAway) {
  for (const bool tells : {true, false}) {
    for (const Chain& chain : {Chain{.lost = 0.05, .tells_torque = tells},
                               {.lost_samples = 0.14, .tells_torque = tells},
                               {.lost = 0.05, .lost_samples = 0.14, .tells_torque = tells}}) {
      const Least half = least_of(chain, 0.5);
      EXPECT_GE(half.work_J, -Passivity::kFloor_J);
      EXPECT_GE(half.account_J, -Passivity::kFloor_J);  // of what nobody saw the worst is booked
      EXPECT_GE(least_of(chain, 1.0).work_J, -Passivity::kFloor_J);
    }
  }
}

TEST(Passivity, AMotorGetsNothingFromAHandThatNeverPaid) {  // constant force along the motion
  Port port(true);
  for (int i = 0; i < 1000; ++i) port.tick([](const Vec3&, const Vec3&) { return Vec3(1, 0, 0); }, Vec3(i < 100, 0, 0));
  EXPECT_LT(port.made.norm(), 0.01);
  EXPECT_GE(port.lowest_J, -Passivity::kFloor_J);
}

TEST(Passivity, APaidSpringIsFeltInFull) {  // pull 1 cm slowly and hold: what the hand has paid it may feel
  Port port(true);
  const double rate = 2.0 * std::acos(-1.0);
  for (int i = 0; i < 2000; ++i) {
    const bool pulls = i < 500;
    port.tick(spring, Vec3(pulls ? 0.0025 * rate * rate * std::cos(rate * i * kT_s) : -50.0 * port.v.x(), 0, 0));
  }
  EXPECT_GT(port.p.norm(), 0.002);
  EXPECT_NEAR(port.made.norm(), 400.0 * port.p.norm(), 0.01 * 400.0 * port.p.norm());
}

/// A hand that draws so far at 15 mm/s and rests, on counts and whole torque quanta. @return share of its rest in which
/// it feels four fifths of K x.
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

TEST(Passivity, ASlowPullOnCountsIsFelt) {  // it has to begin with one quantum, which the floor must pay for
  EXPECT_GT(felt_of_a_slow_pull({}, 0.006), 0.95);
}

TEST(Passivity, ASlowPullIsFeltThroughLostFrames) {  // 5 % of the frames; a set of samples is lost with any of three
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
