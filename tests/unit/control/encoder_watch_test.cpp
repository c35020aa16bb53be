// The encoder watch finds wrong encoders and raises no false alarm on normal hand motions.
#include "firmware/control/encoder_watch.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <functional>

#include "tests/support/honest_hands.hpp"
#include "tests/support/random.hpp"

namespace ligature::control {
namespace {

constexpr std::array<bool, 3> kFree{true, true, true};
using Counts = std::array<double, 3>;

/// A slow motion of the three joints: 0.45, 1.0 and 1.6 counts per period at t = 0, the moment at which the encoder
/// fails.
Counts motion(int t) { return {0.45 * t - 1e-4 * t * t, 1.0 * t - 2e-3 * t * t, 1.6 * t - 2e-3 * t * t}; }

Counts counted(Counts c) {
  for (double& x : c) x = std::round(x);
  return c;
}

/// The fault, the number of samples after t = 0 at which it was reported, and the joint.
struct Report {
  Fault fault = Fault::kNone;
  int when = 0;
  int joint = -1;
};
Report watch(const std::function<Counts(int)>& shown, int until = 300, std::array<bool, 3> free = kFree) {
  EncoderWatch w;
  for (int t = -200; t < until; ++t) {
    const JointFault f = w.add(shown(t), 1, free);
    if (f.fault != Fault::kNone) return {f.fault, t, f.joint};
  }
  return {Fault::kNone, until};
}

TEST(EncoderWatch, AnHonestHandIsNotSuspected) {
  EXPECT_EQ(watch([](int t) { return counted(motion(t)); }).fault, Fault::kNone);
}

TEST(EncoderWatch, AFrozenJointIsSeenWhileTheOthersMoveOn) {
  for (const std::size_t j : {1U, 2U}) {  // joint 0 is too slow to decide
    const auto [fault, when, joint] = watch([j](int t) {
      Counts c = counted(motion(t));
      if (t > 0) c[j] = counted(motion(0))[j];
      return c;
    });
    EXPECT_EQ(fault, Fault::kEncoderFrozen) << j;
    EXPECT_LE(when, 120) << j;
    EXPECT_EQ(joint, static_cast<int>(j));
  }
}

TEST(EncoderWatch, AReversedJointIsSeen) {
  for (std::size_t j = 0; j < 3; ++j) {
    const auto [fault, when, joint] = watch([j](int t) {
      Counts c = counted(motion(t));
      if (t > 0) c[j] = 2.0 * counted(motion(0))[j] - c[j];
      return c;
    });
    EXPECT_EQ(fault, Fault::kAxisReversed) << j;
    EXPECT_LE(when, 40) << j;
    EXPECT_EQ(joint, static_cast<int>(j));
  }
}

TEST(EncoderWatch, AJointInItsStopIsNoFault) {
  const auto stop = [](int t) {
    Counts c = counted(motion(t));
    if (t > 0) c[1] = counted(motion(0))[1];
    return c;
  };
  EXPECT_EQ(watch(stop, 300, {true, false, true}).fault, Fault::kNone);
}

/// Twenty minutes of normal hand motions. In 300 hours of them, 60 of abrupt ones, there was one false alarm, at an
/// abrupt hand (docs/measurements/encoder-watch.md). So one in four minutes of abrupt hands happens in a run of 900,
/// and two in a run of a million.
TEST(EncoderWatch, HandsThatTurnStopAndTrembleAreNotSuspected) {
  test::Random random(23);
  for (const auto kind : test::HonestHand::kKinds) {
    int alarms = 0;
    double most = 0.0;
    for (int run = 0; run < 48; ++run) {
      test::HonestHand hand(kind, random());
      EncoderWatch w;
      bool is_suspected = false;
      for (int t = 0; t < 5000 && !is_suspected; ++t) {
        is_suspected = w.add(hand.next(), 1, kFree).fault != Fault::kNone;
        most = std::max(most, w.reversal(kFree).strength);
      }
      alarms += is_suspected ? 1 : 0;
    }
    EXPECT_LE(alarms, kind == test::HonestHand::Kind::kAbrupt ? 1 : 0) << test::HonestHand::name(kind);
    std::printf("%s: up to %.2f of a reversal\n", test::HonestHand::name(kind), most);
  }
}

/// A hand may itself reverse a joint's motion. If the reversal takes so long (constant acceleration of at most `most`)
/// that the path differs by two counts or more from an instant reversal, it must not be taken for an encoder fault.
TEST(EncoderWatch, ATurnThatTakesItsTimeIsNotSuspected) {
  test::Random random(24);
  for (const MirroredTurn::Look& look : MirroredTurn::kLooks) {
    const double most = 0.5 * look.moving * look.moving;  // counts per period^2
    std::printf("from %.2f counts a period on: hands of up to %.0f m/s2\n", look.moving, 50.0 * most);
    for (int run = 0; run < 500; ++run) {
      const double u = look.moving * random.in(1.0, 1.4), a = most * random.in(0.1, 1.0), at_rest = random.share();
      const double drift = look.alone ? 0.0 : random.in(0.4, 2.0);
      const auto along = [&](double t) {
        const double s = std::abs(t);
        return s < u / a ? 0.5 * a * s * s : u * s - 0.5 * u * u / a;
      };
      const auto [fault, when, none] = watch([&](int t) { return counted({along(t + at_rest), drift * t, 0.0}); });
      EXPECT_EQ(fault, Fault::kNone) << 50.0 * a << " m/s2 at " << u << " counts a period, told at " << when;
    }
  }
}

/// From one sample to the next, one axis of a steadily moving hand counts backwards, alone or with the other axes.
TEST(EncoderWatch, AReversalIsToldTheSoonerTheFaster) {
  test::Random random(25);
  constexpr std::array<std::pair<double, int>, 4> kUntil{{{0.46, 24}, {0.62, 24}, {0.9, 12}, {1.5, 6}}};
  for (std::size_t i = 0; i < kUntil.size(); ++i) {
    for (int run = 0; run < 200; ++run) {
      const double u = random.in(kUntil[i].first, i + 1 < kUntil.size() ? kUntil[i + 1].first : 10.0);
      const double at = random.share(), others = i == 0 ? 0.6 : 0.0;
      const auto shown = [&](int t) {
        Counts c = counted({others * t, u * t + at, 0.0});
        if (t > 0) c[1] = 2.0 * std::round(at) - c[1];
        return c;
      };
      const auto [fault, when, joint] = watch(shown);
      EXPECT_EQ(fault, Fault::kAxisReversed) << u;
      EXPECT_LE(when, kUntil[i].second) << u;
    }
  }
}

TEST(EncoderWatch, ASlowJointIsJudgedOnlyWhileAnotherMovesOn) {
  for (const double others : {0.0, 0.6}) {
    const auto shown = [&](int t) { return counted({others * t, t > 0 ? -0.5 * t : 0.5 * t, 0.0}); };
    EXPECT_EQ(watch(shown).fault, others > 0.0 ? Fault::kAxisReversed : Fault::kNone);
  }
}

TEST(EncoderWatch, AnEncoderThatNeverMovedIsSeenUnderTorque) {  // 0.3 of the rated torque, while the other joints move
  for (std::size_t j = 0; j < 3; ++j) {
    for (const bool frozen : {true, false}) {
      EncoderWatch w;
      Fault fault = Fault::kNone;
      for (int t = 0; t < 500 && fault == Fault::kNone; ++t) {
        Counts c = counted(motion(t));
        c[j] = frozen || t < 250 ? 0.0 : 1.0;  // a single count proves that the encoder works
        std::array<double, 3> torque{};
        torque[j] = 0.3 * std::min(1.0, t / 450.0);
        const JointFault told = w.add(c, 1, kFree, torque);
        fault = told.fault;
        EXPECT_EQ(told.joint, fault != Fault::kNone ? static_cast<int>(j) : -1);
      }
      EXPECT_EQ(fault, frozen ? Fault::kEncoderFrozen : Fault::kNone) << j;
    }
  }
}

TEST(EncoderWatch, AJointThatNobodyPushesMayRestForEver) {
  EncoderWatch w;
  for (int t = 0; t < 3000; ++t) {
    const int tens = t / 10;
    ASSERT_EQ(w.add({0.0, 3.0 * tens, 0.0}, 1, kFree, {0.05 * std::sin(0.01 * t), 0.5, 0.0}), JointFault{}) << t;
  }
}

/// Gaps restart the check: an encoder fault that takes up to 120 samples to find is not found if a gap interrupts the
/// samples every 20 samples.
TEST(EncoderWatch, AGapStartsAnew) {
  for (const bool reversed : {true, false}) {
    for (const std::int64_t gap : {1, 0, 2}) {  // periods; 0: unknown length
      EncoderWatch w;
      Fault fault = Fault::kNone;
      for (int t = -200; t < 200 && fault == Fault::kNone; ++t) {
        Counts c = counted(motion(t)), then = counted(motion(0));
        if (t > 0) c[2] = reversed ? 2.0 * then[2] - c[2] : then[2];
        fault = w.add(c, t % 20 == 0 ? gap : 1, kFree).fault;
      }
      EXPECT_EQ(fault, gap != 1 ? Fault::kNone : reversed ? Fault::kAxisReversed : Fault::kEncoderFrozen) << gap;
    }
  }
}

/// After a gap in the samples an earlier suspicion must be dropped: here the joint moves again for 30 samples and then
/// stops normally.
TEST(EncoderWatch, ASuspicionEndsWithAGap) {
  const auto frozen = [](int t) {
    Counts c = counted(motion(t));
    if (t > 0) c[2] = counted(motion(0))[2];
    return c;
  };
  const int gap = watch(frozen).when - 5;  // five samples before the fault would be reported
  ASSERT_LE(gap, 120);
  EncoderWatch w;
  for (int t = -200; t < gap + 100; ++t) {
    Counts c = frozen(t);
    c[2] += std::round(0.3 * std::clamp(t - gap, 0, 30));
    ASSERT_EQ(w.add(c, t == gap ? 2 : 1, kFree), JointFault{}) << t;
  }
}

/// Joint 0 rests from the start, so the watch sees no sudden stop of it; the other joints move, and the torque of joint
/// 0 changes once.
struct UnderTorque {
  double torque = 0.3, per_sample = 20.0;  ///< share of the rated torque; counts per sample of each other joint
  int samples = 500;
  bool free = true;
  /// @return the number of samples until the fault is reported, 0: never
  [[nodiscard]] int told_after() const {
    EncoderWatch w;
    for (int t = 0; t < samples; ++t) {
      const Fault fault =
          w.add({0.0, per_sample * t, per_sample * t}, 1, {free, true, true}, {t > 0 ? torque : 0.0}).fault;
      if (fault != Fault::kNone) return fault == Fault::kEncoderFrozen ? t + 1 : -1;
    }
    return 0;
  }
};

TEST(EncoderWatch, UnderTorqueAJointMayRestForAHundredSamples) {  // as in a fast hand that reverses
  EXPECT_EQ(UnderTorque{}.told_after(), 100);
  EXPECT_EQ(UnderTorque{.samples = 99}.told_after(), 0);
}

TEST(EncoderWatch, UnderTorqueAJointIsAskedForAFifthOfItsTorqueAndTravelElsewhere) {
  EXPECT_EQ(UnderTorque{.torque = 0.19}.told_after(), 0);
  EXPECT_EQ(UnderTorque{.torque = -0.21}.told_after(), 100);
  // When the two other joints together have moved 300 counts.
  EXPECT_EQ(UnderTorque{.per_sample = 0.5}.told_after(), 301);
  EXPECT_EQ((UnderTorque{.per_sample = 0.5, .samples = 300}.told_after()), 0);
}

TEST(EncoderWatch, AJointInItsStopMayBePushedAndMayBounce) {
  EXPECT_EQ(UnderTorque{.free = false}.told_after(), 0);
  const auto bounce = [](int t) {
    Counts c = counted(motion(t));
    if (t > 0) c[1] = 2.0 * counted(motion(0))[1] - c[1];
    return c;
  };
  EXPECT_EQ(watch(bounce, 300, {true, false, true}).fault, Fault::kNone);
  EXPECT_EQ(watch(bounce, 300).fault, Fault::kAxisReversed);
}

}  // namespace
}  // namespace ligature::control
