// LossWatch reports a fault when too many frames of a bus are lost. Tested: at which loss, how fast, and how rarely on
// a good bus.
#include "firmware/control/loss_watch.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "firmware/control/sample_age.hpp"
#include "tests/support/random.hpp"
#include "tests/unit/control/controller_rig.hpp"

namespace ligature::control {
namespace {

/// Share of samples lost for a given share of frames lost: a sample consists of three frames.
double samples_lost(double frames) { return 1.0 - std::pow(1.0 - frames, 3.0); }

/// Exact distribution of the loss counter under independent losses: probability of each value, and of no fault so far.
class Count {
 public:
  explicit Count(double share) : share_(share) { at_[0] = 1.0; }
  double after(int ticks) {  // share of buses without a fault after that many ticks
    for (; ticks > 0; --ticks) {
      std::array<double, LossWatch::kMost> next{};
      for (int i = 0; i < LossWatch::kMost; ++i) {
        const double p = at_[static_cast<std::size_t>(i)];
        if (i + LossWatch::kLost < LossWatch::kMost) next[static_cast<std::size_t>(i + LossWatch::kLost)] += share_ * p;
        next[static_cast<std::size_t>(std::max(0, i - LossWatch::kCame))] += (1.0 - share_) * p;
      }
      at_ = next;
    }
    double sum = 0.0;
    for (const double p : at_) sum += p;
    return sum;
  }

 private:
  double share_;
  std::array<double, LossWatch::kMost> at_{};
};

struct Bound {
  double frames;
  int ticks;
};

// For each of these shares of lost frames the fault comes within the given number of ticks, except once in a million
// runs.
TEST(LossWatch, ABadBusIsNamedWithinABoundedTimeButOnceInAMillionTimes) {
  for (const auto& [frames, ticks] : {Bound{0.15, 2100}, Bound{0.2, 430}, Bound{0.25, 220}, Bound{0.5, 65}}) {
    Count count(samples_lost(frames));
    EXPECT_LT(count.after(ticks), 1e-6) << frames;
  }
}

TEST(LossWatch, AnHonestRigHasNoAlarm) {
  for (const auto& [frames, per_hour] : {std::pair{0.02, 1e-9}, {0.05, 1e-9}, {0.08, 1e-3}, {0.1, 2.0}}) {
    Count count(samples_lost(frames));
    const double settled = count.after(1000), later = count.after(10000);
    EXPECT_LE((settled - later) / 10000.0 * 3.6e6, per_hour + 1e-8) << frames;  // 1e-8: rounding errors
  }
}

/// A LossWatch that gets the readings of successive ticks, as in the controller.
struct Watched {
  explicit Watched(std::int32_t watchdog_ticks = 20) : watch(watchdog_ticks) {}
  void look(const rt::HandReading& r) {
    age.look(r, tick, tick - 1);
    ++tick;
    watch.look(r, age.is_fresh());
  }
  [[nodiscard]] bool is_lossy() const { return watch.is_lossy(); }
  LossWatch watch;
  SampleAge age;
  std::int64_t tick = 0;
};

/// Ticks until the fault, with independent random losses: `samples` of the samples, `torques` of the torques; -1: none.
int ticks_to_fault(test::Random& random, double samples, double torques, int ticks) {
  Watched watch;
  rt::HandReading r;
  r.valid = true;
  for (int k = 1; k <= ticks; ++k) {
    const bool lost = random.happens(samples), held = random.happens(torques);
    r.age_ticks = lost ? r.age_ticks + 1 : 0;
    if (!lost) r.torque_held[2] = held ? 1 : 0;
    watch.look(r);
    if (watch.is_lossy()) return k;
  }
  return -1;
}

TEST(LossWatch, CountsSamplesAndTorquesEachForItself) {
  test::Random random(1);
  for (int i = 0; i < 300; ++i) {
    EXPECT_NE(ticks_to_fault(random, 0.6, 0.0, 300), -1);
    EXPECT_NE(ticks_to_fault(random, 0.0, 0.6, 300), -1);
    EXPECT_EQ(ticks_to_fault(random, 0.15, 0.15, 10000), -1);
    EXPECT_EQ(ticks_to_fault(random, 0.0, 0.0, 100), -1);
  }
}

/// If no samples come at all, LossWatch leaves the fault to the watchdog, whatever the watchdog's time limit. The loss
/// of half of the samples is still found.
TEST(LossWatch, LeavesASilenceToTheWatchdog) {
  for (const int watchdog : {2, 20, 21, 300, 1000, 10000}) {
    Watched silent(watchdog), half(watchdog);
    rt::HandReading r;
    r.valid = true;
    for (int k = 1; k <= watchdog; ++k) {
      r.age_ticks = k;
      silent.look(r);
      EXPECT_FALSE(silent.is_lossy()) << watchdog << " " << k;
    }
    int k = 0;
    for (; k < 7 * watchdog + 200 && !half.is_lossy(); ++k) {
      r.age_ticks = k % 2;
      half.look(r);
    }
    EXPECT_TRUE(half.is_lossy()) << watchdog;
  }
}

TEST(LossWatch, ASilenceOfAHandIsTheFaultOfTheRigsOwnWatchdog) {
  for (const int watchdog : {20, 300}) {
    Rig rig(Rig::scene(), device::omni(), watchdog);
    rig.ticks(1000);
    for (int k = 0; k < watchdog + 2; ++k) {
      ++rig.in.reading.hand[0].age_ticks;
      rig.tick();
    }
    EXPECT_EQ(rig.controller.fault(), Fault::kTpdoTooOld) << watchdog;
  }
}

TEST(LossWatch, ASampleThatComesAPeriodLateIsNotLost) {
  Watched watch;
  rt::HandReading r;
  r.valid = true;
  r.age_ticks = 1;
  for (int k = 0; k < 1000; ++k) watch.look(r);
  EXPECT_FALSE(watch.is_lossy());
}

TEST(LossWatch, OfEitherHandItTakesAllForceInEveryStateAndAResetBeginsAnew) {
  for (const std::size_t hand : {0U, 1U}) {
    for (const bool by_torque : {false, true}) {
      for (const int ticks : {10, 100, 1000}) {  // CALIBRATE, gain rising, FORCE
        Rig rig;
        rig.ticks(ticks);
        auto& reading = rig.in.reading.hand[hand];
        int k = 0;
        for (; k < 200 && rig.controller.fault() == Fault::kNone; ++k) {  // every second one is lost
          reading.age_ticks = by_torque ? 0 : k % 2;
          reading.torque_held[2] = by_torque ? k % 2 : 0;
          rig.tick();
        }
        EXPECT_EQ(rig.controller.fault(), Fault::kFramesLost) << hand << by_torque << ticks;
        EXPECT_LE(k, 2 * LossWatch::kMost + 2);
        reading.age_ticks = reading.torque_held[2] = 0;
        EXPECT_EQ(Rig::largest(rig.tick()), 0.0);
        EXPECT_EQ(rig.controller.state(), State::kFault);
        rig.controller.command(rt::CommandKind::kResetFault);
        rig.ticks(60);
        EXPECT_EQ(rig.controller.fault(), Fault::kNone);
      }
    }
  }
}

}  // namespace
}  // namespace ligature::control
