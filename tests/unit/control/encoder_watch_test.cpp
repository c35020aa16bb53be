// Lies are found, hands are not suspected.
#include "firmware/control/encoder_watch.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <random>

namespace ligature::control {
namespace {

constexpr std::array<bool, 3> kFree{true, true, true};
using Counts = std::array<double, 3>;

/// A slow curve, 0.45, 1.0 and 1.6 counts a period at t = 0: what the operator of the fault scripts does at its onset.
Counts motion(int t) { return {0.45 * t - 1e-4 * t * t, 1.0 * t - 2e-3 * t * t, 1.6 * t - 2e-3 * t * t}; }

Counts counted(Counts c) {
  for (double& x : c) x = std::round(x);
  return c;
}

/// Fault and how many samples after t = 0 it was told.
std::pair<Fault, int> watch(const std::function<Counts(int)>& shown, int until = 300,
                            std::array<bool, 3> free = kFree) {
  EncoderWatch w;
  for (int t = -200; t < until; ++t) {
    const Fault f = w.add(shown(t), 1, free);
    if (f != Fault::kNone) return {f, t};
  }
  return {Fault::kNone, until};
}

TEST(EncoderWatch, AnHonestHandIsNotSuspected) {
  EXPECT_EQ(watch([](int t) { return counted(motion(t)); }).first, Fault::kNone);
}

TEST(EncoderWatch, AFrozenJointIsSeenWhileTheOthersMoveOn) {
  for (const std::size_t j : {1U, 2U}) {  // the first one is too slow to be sure
    const auto [fault, when] = watch([j](int t) {
      Counts c = counted(motion(t));
      if (t > 0) c[j] = counted(motion(0))[j];
      return c;
    });
    EXPECT_EQ(fault, Fault::kEncoderFrozen) << j;
    EXPECT_LE(when, 120) << j;
  }
}

TEST(EncoderWatch, AReversedJointIsSeen) {
  for (std::size_t j = 0; j < 3; ++j) {
    const auto [fault, when] = watch([j](int t) {
      Counts c = counted(motion(t));
      if (t > 0) c[j] = 2.0 * counted(motion(0))[j] - c[j];
      return c;
    });
    EXPECT_EQ(fault, Fault::kAxisReversed) << j;
    EXPECT_LE(when, 40) << j;
  }
}

TEST(EncoderWatch, AJointInItsStopIsNoFault) {
  const auto stop = [](int t) {
    Counts c = counted(motion(t));
    if (t > 0) c[1] = counted(motion(0))[1];
    return c;
  };
  EXPECT_EQ(watch(stop, 300, {true, false, true}).first, Fault::kNone);
}

TEST(EncoderWatch,
     HandsThatTurnStopAndTrembleAreNotSuspected) {  // a mass of 45 g on 800 N/m and 8 N s/m after a wild wish
  std::mt19937 random(23);
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  int samples = 0;
  for (int run = 0; run < 60; ++run) {
    EncoderWatch w;
    std::array<double, 3> x{}, v{}, wish{}, speed{};
    for (int t = 0; t < 5000; ++t, ++samples) {
      if (t % (40 + 7 * run) == 0) {
        for (auto& s : speed)
          s = any(random) * (any(random) > 0.0 ? 2.0 : 0.0) * 1e3;  // counts/s; sharp corners of the wish
      }
      Counts c{};
      for (std::size_t j = 0; j < 3; ++j) {
        wish[j] += speed[j] * 1e-3;
        for (int i = 0; i < 4; ++i) {
          v[j] += 0.25e-3 * (800.0 * (wish[j] - x[j]) + 8.0 * (speed[j] - v[j])) / 0.045;
          x[j] += 0.25e-3 * v[j];
        }
        c[j] = std::round(x[j] + (run % 3 == 0 ? 3.0 * std::sin(0.06 * t + static_cast<double>(j)) : 0.0));
      }
      ASSERT_EQ(w.add(c, 1, kFree), Fault::kNone) << run << " at " << t;
    }
  }
  EXPECT_EQ(samples, 300'000);
}

TEST(EncoderWatch, AnEncoderThatNeverMovedIsSeenUnderTorque) {  // 0.3 of the rated torque while the others travel
  for (std::size_t j = 0; j < 3; ++j) {
    for (const bool frozen : {true, false}) {
      EncoderWatch w;
      Fault fault = Fault::kNone;
      for (int t = 0; t < 500 && fault == Fault::kNone; ++t) {
        Counts c = counted(motion(t));
        c[j] = frozen || t < 250 ? 0.0 : 1.0;  // one count is enough to be believed
        std::array<double, 3> torque{};
        torque[j] = 0.3 * std::min(1.0, t / 450.0);
        fault = w.add(c, 1, kFree, torque);
      }
      EXPECT_EQ(fault, frozen ? Fault::kEncoderFrozen : Fault::kNone) << j;
    }
  }
}

TEST(EncoderWatch, AJointThatNobodyPushesMayRestForEver) {
  EncoderWatch w;
  for (int t = 0; t < 3000; ++t) {
    ASSERT_EQ(w.add({0.0, 3.0 * (t / 10), 0.0}, 1, kFree, {0.05 * std::sin(0.01 * t), 0.5, 0.0}), Fault::kNone) << t;
  }
}

TEST(EncoderWatch, AGapStartsAnew) {
  EncoderWatch w;
  for (int t = -200; t < 200; ++t) {
    Counts c = counted(motion(t));
    if (t > 0) c[0] = 0.0;
    EXPECT_EQ(w.add(c, t % 20 == 0 ? 2 : 1, kFree), Fault::kNone);
  }
}

}  // namespace
}  // namespace ligature::control
