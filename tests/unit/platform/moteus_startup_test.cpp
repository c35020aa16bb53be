// Start-up and operation of one hand with simulated moteus drives that misbehave. Every refusal must leave the drives
// off, or name those that are not.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "tests/support/random.hpp"
#include "tests/unit/platform/moteus_hand.hpp"

namespace ligature::platform {
namespace {

using rt::DriveRequest;
using sim::MoteusSettings;
using std::chrono::milliseconds;

bool is_stop(const can::Frame& f) { return f.dlc == 3 && f.data[0] == 1 && f.data[2] == 0; }
bool is_torque(const can::Frame& f) { return f.dlc == 32; }

TEST(MoteusStartUp, AcceptsGoodDrivesAndLeavesThemOff) {
  MoteusHand rig;
  EXPECT_EQ(rig.start(), "accepted");
  EXPECT_TRUE(rig.is_off());
  EXPECT_EQ(rig.most_Nm, 0.0F);
  EXPECT_TRUE(rig.enable());
}

/// In each row node 3 misbehaves in another way, and start-up must say how.
TEST(MoteusStartUp, RefusesAndLeavesEveryDriveOff) {
  struct Row {
    const char* says;
    MoteusSettings drive;
  };
  const Row rows[] = {
      {"node 3 (mode 10, fault 0): no watchdog of 20 ms", {.has_watchdog = false}},
      {"node 3 (mode 0, fault 0): its position counts from power-on (home state 0)", {.home = 0}},
      {"node 3 (mode 10, fault 0): does not switch on and stay so", {.takes_gains = false}},
      {"node 3 (mode 1, fault 39): does not switch on and stay so", {.fault_when_on = 39}},
      {"node 3 (mode 2, fault 0): does not switch on and stay so", {.prepares = milliseconds(2000)}},
      {"node 3 (mode 0, fault 0): does not say that it has stopped",
       {.answers_after = std::chrono::microseconds(1500)}},
      {"node 3 (mode 6, fault 0): does not say that it has stopped", {.starts_in = 6, .obeys_stop = false}},
  };
  for (const Row& row : rows) {
    MoteusHand rig(row.drive);
    const std::string said = rig.start();
    EXPECT_EQ(said.find(row.says), 0U) << row.says << ": " << said;
    EXPECT_EQ(rig.is_off(), row.drive.obeys_stop) << row.says;
    const bool complains =
        said.find("node 3 (mode 6, fault 0): does not say that it is off: cut its power") != said.npos;
    EXPECT_EQ(complains, !row.drive.obeys_stop) << said;
  }
}

TEST(MoteusStartUp, AStoredModeIsEndedBeforeAnythingElse) {
  MoteusHand rig({.starts_in = 6});
  EXPECT_GT(rig.torque(), 0.0F) << "a fixed voltage pushes";
  EXPECT_EQ(rig.start(), "accepted");
  EXPECT_TRUE(rig.is_off());
}

TEST(MoteusStartUp, ADriveThatDoesNotAnswerIsNamed) {
  MoteusHand rig;
  rig.nodes[1].answers = false;
  const std::string said = rig.start();
  EXPECT_EQ(said.find("node 2: no answer to a query"), 0U) << said;
  EXPECT_NE(said.find("node 2: does not say that it is off: cut its power"), std::string::npos) << said;
}

TEST(MoteusStartUp, RefusesADriveWithoutAPosition) {
  MoteusHand rig;
  rig.nodes[1].position_rev = std::nanf("");
  EXPECT_EQ(rig.start(), "node 2 (mode 0, fault 0): its position is no number");
  EXPECT_TRUE(rig.is_off());
}

/// The module is silent, repeats its frame, or counts by itself: then its counter is the register now and again.
TEST(MoteusStartUp, RefusesButtonsWithoutSignOfLife) {
  const std::function<void(Buttons&)> changes[] = {[](Buttons& b) { b.answers = false; },
                                                   [](Buttons& b) { b.counts = false; },
                                                   [](Buttons& b) { b.echoes = false; }};
  for (const auto& change : changes) {
    MoteusHand rig;
    change(rig.buttons);
    EXPECT_EQ(rig.start().find("the button module does not answer"), 0U) << &change - changes;
    EXPECT_TRUE(rig.is_off());
  }
}

TEST(MoteusStartUp, HearsAnotherController) {
  MoteusHand rig;
  EXPECT_FALSE(rig.drives.other_controller(rig.wait));
  rig.bus.inbox.push_back({can::kExtendedBit | 0x8502, 8, {0x11, 0x00}, can::Format::kFdFast});
  EXPECT_NE(rig.drives.other_controller(rig.wait).value_or("").find("it sends queries"), std::string::npos);
  EXPECT_NE(rig.start().find("another controller is on this bus"), std::string::npos);
  EXPECT_TRUE(rig.is_off());
}

/// After a refusal the stops are the next frames, with no wait before them, and the answers to later queries confirm
/// them. A drive that resists is named.
TEST(MoteusStartUp, StopsAtOnceAfterARefusal) {
  MoteusHand rig({.has_watchdog = false});
  const auto deliver = rig.bus.on_send;
  Nanoseconds last{0}, longest{0};
  bool is_after_silence = false;
  std::vector<bool> after;  // the frames after the trial of the watchdog: is it a stop?
  rig.bus.on_send = [&](const can::Frame& f) {
    is_after_silence = is_after_silence || rig.wait.time - last > milliseconds(15);
    if (!after.empty()) longest = std::max(longest, rig.wait.time - last);
    if (is_after_silence) after.push_back(is_stop(f));
    last = rig.wait.time;
    deliver(f);
  };
  EXPECT_EQ(rig.start(),
            "node 3 (mode 10, fault 0): no watchdog of 20 ms: it is not in the mode 11 after so long a silence");
  ASSERT_GT(after.size(), 6U);
  EXPECT_EQ(std::vector<bool>(after.begin(), after.begin() + 6),
            (std::vector<bool>{false, false, false, true, true, true}))
      << "the three queries of the trial, then stops";
  EXPECT_LE(longest, milliseconds(1)) << "one period for the answers, and none between stops";
  EXPECT_TRUE(rig.is_off());
}

/// The bus refuses any one of the frames: the drives are accepted or refused, but off in the end.
TEST(MoteusStartUp, ARefusedFrameLeavesNoDriveOn) {
  int accepted = 0;
  for (long n = 0; n < 400; n += 1 + n / 40) {
    MoteusHand rig;
    rig.bus.refuse_at = n;
    accepted += rig.start() == "accepted" ? 1 : 0;
    EXPECT_TRUE(rig.is_off()) << n;
    EXPECT_EQ(rig.most_Nm, 0.0F);
  }
  EXPECT_GT(accepted, 10) << "what is lost is sent again";
}

/// A stop that the bus refuses for some periods is sent until it takes it.
TEST(MoteusInOperation, ARefusedStopIsSentAgain) {
  MoteusHand rig;
  ASSERT_EQ(rig.start(), "accepted");
  ASSERT_TRUE(rig.enable());
  (void)rig.period(DriveRequest::kOperate, 0.2);
  ASSERT_GT(rig.torque(), 0.1F);
  rig.drives.request();
  rig.drives.drain();
  for (int k = 0; k < 3; ++k) {
    rig.bus.lost = true;
    rig.drives.write({{}, DriveRequest::kHold});
    EXPECT_TRUE(rig.drives.reading().bus_lost);
  }
  rig.bus.lost = false;
  EXPECT_GT(rig.torque(), 0.1F);
  (void)rig.period(DriveRequest::kHold);
  EXPECT_EQ(rig.torque(), 0.0F);
  EXPECT_FALSE(rig.drives.release(rig.wait));
}

TEST(MoteusInOperation, ReleaseNamesEveryDriveThatStaysOn) {
  MoteusHand rig({.obeys_stop = false}, {.obeys_stop = false});
  for (auto& node : rig.nodes) node.set_mode(7);
  EXPECT_EQ(
      rig.drives.release(rig.wait).value_or(""),
      "node 1 (mode 7, fault 0): does not say that it is off: cut its power; node 2 (mode 7, fault 0): does not say "
      "that it is off: cut its power; node 3 (mode 7, fault 0): does not say that it is off: cut its power");
  rig.bus.lost = true;
  EXPECT_EQ(rig.drives.release(rig.wait).value_or(""), "the bus is lost: cut the drives' power");
}

/// A stop that the interface refuses because it is down must go out as soon as it is up. The drives say nothing before.
TEST(MoteusInOperation, ReleaseGoesOnWhileTheBusIsLost) {
  MoteusHand rig;
  ASSERT_EQ(rig.start(), "accepted");
  ASSERT_TRUE(rig.enable());
  (void)rig.period(DriveRequest::kOperate, 0.2);
  rig.bus.lost = true;
  const Nanoseconds up = rig.wait.time + milliseconds(50);
  rig.wait.on_wait = [&] {
    if (rig.wait.time >= up) rig.bus.lost = false;
    rig.advance();
  };
  EXPECT_EQ(rig.drives.release(rig.wait), std::nullopt);
  EXPECT_TRUE(rig.is_off());
  EXPECT_LE(rig.wait.time, up + milliseconds(5));
}

/// What was said before is no answer: a drive whose answers stay away is named.
TEST(MoteusInOperation, ReleaseWantsANewAnswer) {
  MoteusHand rig;
  ASSERT_EQ(rig.start(), "accepted");
  for (int i = 0; i < 5; ++i) (void)rig.period(DriveRequest::kHold);
  rig.nodes[0].answers = false;
  EXPECT_EQ(rig.drives.release(rig.wait).value_or("").find("node 1 (mode 0, fault 0): does not say that it is off"),
            0U);
}

/// A drive that started anew between start-up and the first period is told everything again, and tells it back: it gets
/// no torque before. If it came back as another drive, it stays off.
TEST(MoteusInOperation, AResetBeforeTheFirstPeriodSkipsNoCheck) {
  const std::function<void(MoteusSettings&)> changes[] = {
      [](MoteusSettings&) {}, [](MoteusSettings& s) { s.takes_gains = false; }, [](MoteusSettings& s) { s.home = 2; },
      [](MoteusSettings& s) { s.starts_in = 6, s.obeys_stop = false; }};
  for (const auto& change : changes) {
    const bool is_same = &change == changes;
    for (const int boot_ms : {0, 7, 60}) {
      // The first command ends this drive's stored mode, before its first answer: then it is as the others
      if (&change == std::end(changes) - 1 && boot_ms == 60) continue;
      MoteusHand rig;
      ASSERT_EQ(rig.start(), "accepted");
      change(rig.nodes[1].settings);
      rig.nodes[1].power_cycle(rig.wait.time, milliseconds(boot_ms));
      const Nanoseconds begin = rig.wait.time;
      rig.most_Nm = 0.0F;
      EXPECT_EQ(rig.enable(), is_same) << boot_ms;
      EXPECT_TRUE(!is_same || rig.wait.time - begin >= milliseconds(boot_ms + static_cast<int>(moteus::kExtras)))
          << "a period for each setting";
      EXPECT_TRUE(rig.most_Nm == 0.0F || rig.nodes[1].mode() == 6);
      for (int i = 0; i < 5; ++i) {
        (void)rig.period(DriveRequest::kOperate, 0.2);
        EXPECT_TRUE(is_same || rig.nodes[0].torque_Nm() == 0.0F);
      }
      EXPECT_EQ(rig.nodes[0].torque_Nm() > 0.1F, is_same);
    }
  }
}

/// A drive whose power fails for a moment while it is on says so in its first answer.
TEST(MoteusInOperation, AResetWhileOnIsAFault) {
  test::Random random(13);
  for (int i = 0; i < 20; ++i) {
    MoteusHand rig;
    ASSERT_EQ(rig.start(), "accepted");
    ASSERT_TRUE(rig.enable());
    for (long k = random.any(0, 30); k > 0; --k) (void)rig.period(DriveRequest::kOperate, 0.1);
    rig.nodes[2].power_cycle(rig.wait.time, milliseconds(random.any(0, 15)));
    int ticks = 0;
    while (!rig.period(DriveRequest::kOperate, 0.1).drive_fault && ticks < 100) ++ticks;
    EXPECT_LE(ticks, 18) << "the time without power, and two periods in which nobody is asked";
    EXPECT_EQ(rig.torque(), 0.0F) << "the other drives are stopped in the same period";
    for (int k = 0; k < 60; ++k) (void)rig.period(DriveRequest::kHold);
    EXPECT_TRUE(rig.enable());
  }
}

/// The watchdog: a drive that hears nothing damps the motion, and only a stop ends that.
TEST(MoteusInOperation, AWatchdogThatRanOutDampsUntilTheStop) {
  MoteusHand rig;
  ASSERT_EQ(rig.start(), "accepted");
  ASSERT_TRUE(rig.enable());
  (void)rig.period(DriveRequest::kOperate, 0.2);
  for (auto& node : rig.nodes) node.velocity_rev_per_s = 1.0F;
  for (int tenths = 0; tenths < 210; ++tenths) rig.wait.wait(rig.wait.time + milliseconds(1));
  for (const auto& node : rig.nodes) {
    EXPECT_EQ(node.mode(), 11);
    EXPECT_LT(node.torque_Nm(), 0.0F) << "against the motion";
  }
  EXPECT_TRUE(rig.period(DriveRequest::kOperate, 0.2).drive_fault);
  EXPECT_EQ(rig.torque(), 0.0F);
}

/// A CAN interface of Linux has a queue of ten frames, and refuses more.
TEST(MoteusStartUp, SendsAtMostTenFramesAtOnce) {
  MoteusHand rig;
  int most = 0, waiting = 0, torques = 0;
  const auto deliver = rig.bus.on_send;
  rig.bus.on_send = [&](const can::Frame& f) {
    most = std::max(most, ++waiting);
    torques += is_torque(f) ? 1 : 0;
    deliver(f);
  };
  rig.wait.on_wait = [&] {
    waiting = 0;
    rig.advance();
  };
  EXPECT_EQ(rig.start(), "accepted");
  EXPECT_LE(most, 10);
  EXPECT_GT(torques, 3);
}

}  // namespace
}  // namespace ligature::platform
