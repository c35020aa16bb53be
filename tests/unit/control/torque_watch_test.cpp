// Compares reported with commanded drive torques, over links that lose, delay, duplicate and reorder frames.
#include "firmware/control/torque_watch.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <deque>
#include <optional>

#include "firmware/control/sample_age.hpp"
#include "tests/support/random.hpp"

namespace ligature::control {
namespace {

constexpr std::int32_t kWatchdog = 20;
using Torques = std::array<double, rt::kJoints>;

rt::HandReading reading_of(const Torques& told_Nm, std::int32_t age = 0) {
  rt::HandReading r;
  r.valid = true;
  r.age_ticks = age;
  r.torque_Nm = told_Nm;
  return r;
}

/// A TorqueWatch that gets the readings of successive ticks, as in the controller.
struct Watched {
  Watched(const device::Device& device, std::int32_t watchdog_ticks) : watch(device, watchdog_ticks) {}
  void look(const rt::HandReading& r) {
    age.look(r, tick, tick - 1);
    ++tick;
    watch.look(r, age.is_fresh());
  }
  void sent(const Torques& torque_Nm) { watch.sent(torque_Nm); }
  [[nodiscard]] bool is_astray() const { return watch.is_astray(); }
  TorqueWatch watch;
  SampleAge age;
  std::int64_t tick = 0;
};

/// One joint's drive behind a link that loses, delays or duplicates frames in both directions.
class Drive {
 public:
  Drive(test::Random& random, double loss, int most_delay) : random_(random), loss_(loss), most_delay_(most_delay) {}

  void send(double torque_Nm, int now) {
    if (chance() < loss_) return;
    under_way_.push_back({now + delay(), torque_Nm});
    if (chance() < loss_) under_way_.push_back({now + delay(), torque_Nm});  // duplicated, possibly out of order
  }
  /// At a SYNC the drive reports the torque that acted until now, then applies the latest command. Without a command
  /// for longer than the watchdog's time the torque is zero.
  double sync(int now) {
    const double made_Nm = acting_Nm_;
    std::optional<double> got;
    std::erase_if(under_way_, [&](const auto& f) {
      if (f.due > now) return false;
      got = f.torque_Nm;
      return true;
    });
    silence_ = got ? 0 : silence_ + 1;
    if (got) acting_Nm_ = *got;
    if (silence_ >= kWatchdog) acting_Nm_ = 0.0;
    if (chance() < 0.001) acting_Nm_ = 0.0, under_way_.clear();  // the drive was reset
    return made_Nm;
  }
  double chance() { return random_.share(); }

 private:
  struct UnderWay {
    int due;
    double torque_Nm;
  };
  int delay() { return most_delay_ == 0 ? 0 : static_cast<int>(random_.any(0, most_delay_)); }

  test::Random& random_;
  double loss_;
  int most_delay_;
  std::deque<UnderWay> under_way_;
  double acting_Nm_ = 0.0;
  int silence_ = 0;
};

/// Correct drives with torques that wander, jump and end. @return whether a fault was raised.
bool alarms(unsigned seed, double loss, int most_delay) {
  test::Random random(seed);
  Watched watch(device::omni(), kWatchdog);
  std::array<Drive, 3> drives{Drive(random, loss, most_delay), Drive(random, loss, most_delay),
                              Drive(random, loss, most_delay)};
  const auto step = [&] { return 0.05 * random.normal(); };
  const auto noise = [&] { return 0.002 * random.normal(); };
  Torques sent{}, told{};
  std::int32_t age = 0;
  for (int tick = 0; tick < 2000; ++tick) {
    Torques made{};
    for (std::size_t j = 0; j < 3; ++j) {
      made[j] = drives[j].sync(tick);
      made[j] += noise();
    }
    age = drives[0].chance() < loss ? age + 1 : 0;  // a TPDO is lost: the previous samples are held
    if (age == 0) told = made;
    watch.look(reading_of(told, age));
    if (watch.is_astray()) return true;
    const bool stops = drives[0].chance() < 0.01;
    for (std::size_t j = 0; j < 3; ++j) {
      sent[j] = stops ? 0.0 : std::clamp(sent[j] + step(), -0.9, 0.9);
      drives[j].send(sent[j], tick + 1);
    }
    watch.sent(sent);
  }
  return false;
}

TEST(TorqueWatch, HonestDrivesNeverRaiseIt) {
  constexpr unsigned base = 1;
  for (unsigned i = 0; i < 300; ++i) {
    const double loss = 0.2 * (i % 11) / 10.0;
    const int most_delay = static_cast<int>(i % 4);
    EXPECT_FALSE(alarms(base + i, loss, most_delay))
        << "seed " << base + i << ", loss " << loss << ", delay " << most_delay;
  }
}

TEST(TorqueWatch, APushThatNobodyAskedForIsFoundInItsSecondSample) {
  for (std::size_t joint = 0; joint < 3; ++joint) {
    for (const double sign : {-1.0, 1.0}) {
      Watched watch(device::omni(), kWatchdog);
      Torques told{};
      const double asked = 0.037;  // 123 per mille of the rated torque
      for (int i = 0; i < 50; ++i) watch.look(reading_of(told)), watch.sent({asked, asked, asked});
      told = {asked, asked, asked};
      for (int i = 0; i < 50; ++i) {
        watch.look(reading_of(told));
        ASSERT_FALSE(watch.is_astray());
        watch.sent({asked, asked, asked});
      }
      told[joint] = sign * 0.9;
      watch.look(reading_of(told));
      EXPECT_FALSE(watch.is_astray()) << "one sample may be noise";
      watch.sent({asked, asked, asked});
      watch.look(reading_of(told, 1));
      EXPECT_FALSE(watch.is_astray()) << "the same sample again";
      watch.look(reading_of(told, 1));
      EXPECT_TRUE(watch.is_astray()) << "a later one that came a period late";
      EXPECT_EQ(watch.watch.joint(), static_cast<int>(joint));
    }
  }
}

/// Torque errors up to the device file's tolerance are accepted, in both directions and for torques of either sign.
TEST(TorqueWatch, ToleratesWhatTheRecordSaysAndNoMore) {
  device::Device d = device::omni();
  for (const int permille : {10, 50, 200}) {
    d.torque_tolerance_permille = permille;
    const double tolerance = permille * d.Nm_per_permille();
    for (const double asked : {-0.3, 0.0, 0.3}) {
      for (const double beyond : {-1e-6, 1e-6}) {
        Watched watch(d, kWatchdog);
        for (int i = 0; i < 10; ++i) {
          const double away = (asked < 0.0 ? -1.0 : 1.0) * (tolerance + beyond);
          watch.look(reading_of({i < 3 ? 0.0 : asked + away, 0.0, 0.0}));
          watch.sent({asked, 0.0, 0.0});
        }
        EXPECT_EQ(watch.is_astray(), beyond > 0.0) << permille << " " << asked;
      }
    }
  }
}

/// A command excuses a torque only for a limited time: a drive that keeps that torque is found about one watchdog time
/// later.
TEST(TorqueWatch, ForgetsWhatWasSentLongAgo) {
  for (const std::int32_t watchdog : {2, 5, 20, 100, 1000}) {
    Watched watch(device::omni(), watchdog);
    const auto tick = [&](double told, double asked) {
      watch.look(reading_of({told, 0.0, 0.0}));
      watch.sent({asked, 0.0, 0.0});
    };
    for (int i = 0; i < 100; ++i) tick(i < 2 ? 0.0 : 0.6, 0.6);
    int ticks = 0;
    for (; !watch.is_astray() && ticks < 10000; ++ticks) tick(0.6, 0.0);
    EXPECT_GT(ticks, watchdog) << "an RPDO may have been lost so long";
    EXPECT_LE(ticks, watchdog + watchdog / 7 + 18) << watchdog;  // the history is kept in seven blocks
  }
}

TEST(TorqueWatch, AJointThatTellsNoTorqueTellsByABit) {
  Watched watch(device::omni(), kWatchdog);
  rt::HandReading r = reading_of({0.0, 0.0, rt::HandReading::kNotTold});
  for (int i = 0; i < 5; ++i) watch.look(r), watch.sent({0.0, 0.0, 0.3});
  EXPECT_FALSE(watch.is_astray());
  r.torque_astray[2] = true;
  watch.look(r);
  EXPECT_FALSE(watch.is_astray());
  watch.look(r);
  EXPECT_TRUE(watch.is_astray());
  EXPECT_EQ(watch.watch.joint(), 2);
}

}  // namespace
}  // namespace ligature::control
