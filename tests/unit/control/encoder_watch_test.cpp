// Lies are found, hands are not suspected.
#include "firmware/control/encoder_watch.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

#include "tests/support/random.hpp"

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
  test::Random random(23);
  const auto any = [&] { return random.in(-1.0, 1.0); };
  int samples = 0;
  for (int run = 0; run < 60; ++run) {
    EncoderWatch w;
    std::array<double, 3> x{}, v{}, wish{}, speed{};
    for (int t = 0; t < 5000; ++t, ++samples) {
      if (t % (40 + 7 * run) == 0) {
        for (auto& s : speed) s = any() * (any() > 0.0 ? 2.0 : 0.0) * 1e3;  // counts/s; sharp corners of the wish
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

/// A lie that is found within 120 samples (above), seen with a gap in time every 20.
TEST(EncoderWatch, AGapStartsAnew) {
  for (const bool reversed : {true, false}) {
    for (const std::int64_t gap : {1, 0, 2}) {  // 0: nobody knows how long it was
      EncoderWatch w;
      Fault fault = Fault::kNone;
      for (int t = -200; t < 200 && fault == Fault::kNone; ++t) {
        Counts c = counted(motion(t)), then = counted(motion(0));
        if (t > 0) c[2] = reversed ? 2.0 * then[2] - c[2] : then[2];
        fault = w.add(c, t % 20 == 0 ? gap : 1, kFree);
      }
      EXPECT_EQ(fault, gap != 1 ? Fault::kNone : reversed ? Fault::kAxisReversed : Fault::kEncoderFrozen) << gap;
    }
  }
}

/// What nobody saw may have been a motion: here the joint went on for 30 samples, and stopped as joints do.
TEST(EncoderWatch, ASuspicionEndsWithAGap) {
  const auto frozen = [](int t) {
    Counts c = counted(motion(t));
    if (t > 0) c[2] = counted(motion(0))[2];
    return c;
  };
  const int gap = watch(frozen).second - 5;  // that near to being told
  ASSERT_LE(gap, 120);
  EncoderWatch w;
  for (int t = -200; t < gap + 100; ++t) {
    Counts c = frozen(t);
    c[2] += std::round(0.3 * std::clamp(t - gap, 0, 30));
    ASSERT_EQ(w.add(c, t == gap ? 2 : 1, kFree), Fault::kNone) << t;
  }
}

/// A hand at rest at first: no corner to be seen. The others go on, and the joint's torque changes once.
struct UnderTorque {
  double torque = 0.3, per_sample = 20.0;  ///< of the rated one; counts of each other joint
  int samples = 500;
  bool free = true;
  /// @return samples until it was told, 0: never
  [[nodiscard]] int told_after() const {
    EncoderWatch w;
    for (int t = 0; t < samples; ++t) {
      const Fault fault = w.add({0.0, per_sample * t, per_sample * t}, 1, {free, true, true}, {t > 0 ? torque : 0.0});
      if (fault != Fault::kNone) return fault == Fault::kEncoderFrozen ? t + 1 : -1;
    }
    return 0;
  }
};

TEST(EncoderWatch, UnderTorqueAJointMayRestForAHundredSamples) {  // a fast hand that turns round
  EXPECT_EQ(UnderTorque{}.told_after(), 100);
  EXPECT_EQ(UnderTorque{.samples = 99}.told_after(), 0);
}

TEST(EncoderWatch, UnderTorqueAJointIsAskedForAFifthOfItsTorqueAndTravelElsewhere) {
  EXPECT_EQ(UnderTorque{.torque = 0.19}.told_after(), 0);
  EXPECT_EQ(UnderTorque{.torque = -0.21}.told_after(), 100);
  EXPECT_EQ(UnderTorque{.per_sample = 0.5}.told_after(), 301);  // 300 counts of both
  EXPECT_EQ((UnderTorque{.per_sample = 0.5, .samples = 300}.told_after()), 0);
}

TEST(EncoderWatch, AJointInItsStopMayBePushedAndMayBounce) {
  EXPECT_EQ(UnderTorque{.free = false}.told_after(), 0);
  const auto bounce = [](int t) {
    Counts c = counted(motion(t));
    if (t > 0) c[1] = 2.0 * counted(motion(0))[1] - c[1];
    return c;
  };
  EXPECT_EQ(watch(bounce, 300, {true, false, true}).first, Fault::kNone);
  EXPECT_EQ(watch(bounce, 300).first, Fault::kAxisReversed);
}

}  // namespace
}  // namespace ligature::control
