// Start-up and operation of one hand with simulated ODrives that misbehave. Every refusal must leave the drives off.
// A watchdog of a drive is "fed" by a frame that restarts its time. In the drives' software 0.6 only torque messages
// feed it; in software 0.5 (`has_old_watchdog`) every frame does.
#include <gtest/gtest.h>

#include "firmware/control/dead_man.hpp"
#include "tests/support/random.hpp"
#include "tests/unit/platform/odrive_hand.hpp"

namespace ligature::platform {
namespace {

using sim::OdriveSettings;
using std::chrono::microseconds;
using std::chrono::milliseconds;

/// With both kinds of watchdog.
TEST(OdriveStartUp, AcceptsGoodDrivesAndLeavesThemOff) {
  for (const bool old : {false, true}) {
    OdriveHand rig({.has_old_watchdog = old}, {.has_old_watchdog = old});
    EXPECT_EQ(rig.start(), "accepted") << old;
    EXPECT_TRUE(rig.is_off());
    EXPECT_LT(rig.most_Nm, 0.001F) << "the trial torque must not be felt";
    EXPECT_NEAR(rig.nodes[2].current_limit_A(), 0.9 / 0.083, 1e-4) << "the largest torque over the torque constant";
    EXPECT_TRUE(rig.enable()) << old;
  }
}

/// In each row node 3 misbehaves in another way, and start-up must say how.
TEST(OdriveStartUp, RefusesAndLeavesEveryDriveOff) {
  struct Row {
    const char* says;
    OdriveSettings drive;
  };
  const Row rows[] = {
      {"node 3: no watchdog of 20 ms", {.watchdog = milliseconds(0)}},
      {"node 3: no watchdog of 20 ms", {.watchdog = milliseconds(500)}},
      {"node 3: no watchdog of 20 ms", {.watchdog = milliseconds(40)}},
      {"node 3: does not aim at the torque", {.takes_short_torques = false}},
      {"node 3: does not aim at the torque", {.takes_mode = false}},
      {"node 3: does not aim at the torque", {.control_mode = 2, .takes_mode = false}},
      {"node 3: does not aim at the torque", {.input_mode = 5, .takes_mode = false}},  // trajectories
      {"node 3: does not aim at the torque", {.adds_Nm = 0.001F}},
      {"node 3: fewer than three heartbeats", {.heartbeat = milliseconds(30)}},
      {"node 3: does not say that its software is 0.6", {.software_minor = 5}},
      {"node 3: sends its position without being asked", {.tells_position = milliseconds(10)}},
      {"node 3: sends its position without being asked", {.tells_position = milliseconds(150)}},
      {"node 3: keeps its error", {.has_error = true}},
      {"node 3 does not say that it is off: cut its power",
       {.watchdog = milliseconds(0), .starts_in_closed_loop = true, .obeys_idle = false}},
  };
  for (const Row& row : rows) {
    OdriveHand rig(row.drive);
    const std::string said = rig.start();
    EXPECT_NE(said.find(row.says), std::string::npos) << row.says << ": " << said;
    EXPECT_EQ(rig.is_off(), row.drive.obeys_idle) << row.says;
  }
}

TEST(OdriveStartUp, RefusesARecordWhoseWatchdogIsLongerThanTheOption) {
  OdriveHand rig;
  EXPECT_EQ(OdriveDrives(rig.bus, rig.device, 19)
                .configure(rig.wait)
                .value_or("")
                .find("odrive.watchdog_ms is 20, allowed at most --watchdog-ms, 19"),
            0U);
}

TEST(OdriveStartUp, RefusesButtonsWithoutSignOfLife) {
  for (const bool answers : {false, true}) {
    OdriveHand rig;
    rig.buttons.answers = answers;
    rig.buttons.counts = false;
    EXPECT_EQ(rig.start().find("the button module does not answer"), 0U) << answers;
    EXPECT_TRUE(rig.is_off());
  }
}

/// The bus refuses one random frame of start-up. Start-up must then fail, and switch no drive on after that frame.
TEST(OdriveStartUp, RefusesABusThatTakesNotEveryFrame) {
  OdriveHand whole;
  ASSERT_EQ(whole.start(), "accepted");
  const auto all = static_cast<long>(whole.bus.sent.size());
  test::Random random(11);
  for (int i = 0; i < 60; ++i) {
    OdriveHand rig;
    rig.bus.refuse_at = random.any(0, all - 7);  // the last six switch off
    const auto refused = static_cast<std::size_t>(rig.bus.refuse_at);
    EXPECT_EQ(rig.start().find("the bus takes no frames"), 0U) << refused;
    EXPECT_TRUE(rig.is_off());
    for (std::size_t k = refused; k < rig.bus.sent.size(); ++k) {
      const can::Frame& frame = rig.bus.sent[k];
      EXPECT_FALSE((frame.id & 0x1FU) == 0x07 && frame.data[0] == 8)
          << "closed loop (8) after frame " << refused << " was refused";
    }
  }
}

TEST(OdriveStartUp, AnotherControllerInTheMiddleLeavesTheDrivesOff) {
  test::Random random(12);
  for (int i = 0; i < 20; ++i) {
    OdriveHand rig;
    const Nanoseconds at = microseconds(random.any(1000, 120'000));
    rig.wait.on_wait = [&rig, at] {
      rig.advance();
      if (rig.wait.time == at / microseconds(100) * microseconds(100)) rig.bus.inbox.push_back({0x02E, 4, {}});
    };
    EXPECT_EQ(rig.start().find("another controller"), 0U) << at.count();
    EXPECT_TRUE(rig.is_off());
  }
}

/// The bus refuses one of the frames that switch off (zero torque and idle, for each of three drives). The drives have
/// no watchdog, so a drive whose idle command was refused goes off only if the firmware repeats it.
TEST(OdriveStartUp, SwitchesOffAlsoIfTheBusRefusesTheFirstIdle) {
  const OdriveSettings on{.watchdog = milliseconds(0), .starts_in_closed_loop = true};
  for (int which = 0; which < 6; ++which) {
    OdriveHand rig(on, on);
    ASSERT_FALSE(rig.is_off());
    const Nanoseconds begin = rig.wait.time;
    Nanoseconds off_after = Nanoseconds::max();
    rig.wait.on_wait = [&] {
      rig.advance();
      if (rig.is_off()) off_after = std::min(off_after, rig.wait.time - begin);
    };
    rig.bus.refuse_at = which;
    EXPECT_EQ(rig.drives.release(rig.wait), std::nullopt) << which;
    EXPECT_TRUE(rig.is_off()) << which;
    EXPECT_LE(off_after, milliseconds(2)) << which;
  }
}

/// Node 3 misses the first idle command, for example as it is busy, and obeys the next one. It has no watchdog.
TEST(OdriveStartUp, SwitchesOffADriveThatMissedTheFirstIdle) {
  const OdriveSettings on{.watchdog = milliseconds(0), .starts_in_closed_loop = true};
  OdriveHand rig(on, on);
  rig.nodes[2].obeys = false;
  const Nanoseconds begin = rig.wait.time;
  rig.wait.on_wait = [&] {
    rig.advance();
    if (rig.wait.time - begin >= milliseconds(5)) rig.nodes[2].obeys = true;
  };
  EXPECT_EQ(rig.drives.release(rig.wait), std::nullopt);
  EXPECT_TRUE(rig.is_off());
}

/// In operation too a refused frame must be reported as a lost bus. Otherwise a drive that misses a torque would go on
/// with the old one, and the requests for samples could feed its watchdog. A period sends three requests, then three
/// torques; a refused request is reported in the same period, a refused torque in the next one.
TEST(OdriveInOperation, ARefusedFrameIsALostBus) {
  for (int which = 0; which < 6; ++which) {
    OdriveHand rig;
    ASSERT_EQ(rig.start(), "accepted");
    ASSERT_TRUE(rig.enable());
    EXPECT_FALSE(rig.period(rt::DriveRequest::kOperate, 0.1).bus_lost);
    rig.bus.refuse_at = which;
    EXPECT_EQ(rig.period(rt::DriveRequest::kOperate, 0.1).bus_lost, which < 3) << "a request";
    EXPECT_EQ(rig.period(rt::DriveRequest::kOperate, 0.1).bus_lost, which >= 3) << "a torque";
    EXPECT_FALSE(rig.period(rt::DriveRequest::kOperate, 0.1).bus_lost);
  }
}

/// The longest watchdog of drive 3 that start-up does not tell from 20 ms. It depends on when the heartbeats come.
milliseconds longest_watchdog(bool old) {
  milliseconds longest(40);
  while (longest > milliseconds(20) &&
         OdriveHand({.watchdog = longest, .has_old_watchdog = old}, {.has_old_watchdog = old}).start() != "accepted")
    --longest;
  EXPECT_LE(longest, milliseconds(31));
  return longest;
}

/// The controller has a fault and switches off (kHold), but one drive obeys no command any more. The firmware must send
/// nothing for so long that this drive's watchdog runs out, whichever frames feed it.
TEST(OdriveInOperation, ADriveThatObeysNothingStarves) {
  for (const bool old : {false, true}) {
    OdriveHand rig({.watchdog = longest_watchdog(old), .has_old_watchdog = old}, {.has_old_watchdog = old});
    ASSERT_EQ(rig.start(), "accepted");
    ASSERT_TRUE(rig.enable());
    for (int i = 0; i < 10; ++i) (void)rig.period(rt::DriveRequest::kOperate, 0.1);
    ASSERT_GT(rig.torque(), 0.09F);
    rig.nodes[2].obeys = false;
    int ticks = 0;
    while (rig.torque() > 0.0F && ticks < 500) {
      (void)rig.period(rt::DriveRequest::kHold);
      ++ticks;
    }
    EXPECT_LE(ticks, 32) << "watchdog, and torque 0 and idle before it; old: " << old;
    for (int i = 0; i < 30; ++i) (void)rig.period(rt::DriveRequest::kHold);
    EXPECT_EQ(rig.period(rt::DriveRequest::kHold).age_ticks, 0) << "all are off: samples come again";
    rig.nodes[2].obeys = true;
    EXPECT_TRUE(rig.enable()) << "after a reset";
  }
}

/// The same after a frame of another controller. The firmware answers with emergency stops in ten periods, and these
/// feed an old watchdog. After them it must be silent, too, so that the watchdog runs out.
TEST(OdriveInOperation, ADriveThatObeysNothingStarvesAlsoAfterAStop) {
  OdriveHand rig({.watchdog = longest_watchdog(true), .has_old_watchdog = true}, {.has_old_watchdog = true});
  ASSERT_EQ(rig.start(), "accepted");
  ASSERT_TRUE(rig.enable());
  (void)rig.period(rt::DriveRequest::kOperate, 0.1);
  rig.nodes[2].obeys = false;
  rig.bus.inbox.push_back({0x02E, 4, {}});
  int ticks = 0;
  while (rig.torque() > 0.0F && ++ticks < 500) (void)rig.period(rt::DriveRequest::kStop);
  EXPECT_LE(ticks, 45) << "ten periods with emergency stops, then the watchdog";
}

/// At the end of a run the bus is lost, and comes back after 0.2 s, as an interface that somebody sets up. The drives
/// have no watchdog, so they go off only if the firmware tries again until then.
TEST(OdriveStartUp, ReleaseWaitsForALostBusToComeBack) {
  const OdriveSettings on{.watchdog = milliseconds(0), .starts_in_closed_loop = true};
  OdriveHand rig(on, on);
  rig.bus.lost = true;
  const Nanoseconds begin = rig.wait.time;
  rig.wait.on_wait = [&] {
    rig.bus.lost = rig.wait.time - begin < milliseconds(200);
    rig.advance();
  };
  EXPECT_EQ(rig.drives.release(rig.wait), std::nullopt);
  EXPECT_TRUE(rig.is_off());
}

/// If drives cannot be switched off, the message must name each of them.
TEST(OdriveStartUp, ReleaseNamesEveryDriveThatStaysOn) {
  const OdriveSettings on{.watchdog = milliseconds(0), .starts_in_closed_loop = true, .obeys_idle = false};
  OdriveHand rig(on, on);
  EXPECT_EQ(rig.drives.release(rig.wait).value_or(""),
            "node 1 does not say that it is off: cut its power; node 2 does not say that it is off: cut its power; "
            "node 3 does not say that it is off: cut its power");
  rig.bus.lost = true;
  EXPECT_EQ(rig.drives.release(rig.wait).value_or(""), "the bus is lost: cut the drives' power");
}

/// A CAN interface of Linux has a queue of ten frames, and refuses more. So at most ten may be sent without a wait, or
/// without an answer that shows that the queue is empty.
TEST(OdriveStartUp, SendsAtMostTenFramesAtOnce) {
  OdriveHand rig;
  int most = 0, waiting = 0;
  const auto answer = rig.bus.on_send;
  rig.bus.on_send = [&](const can::Frame& frame) {
    most = std::max(most, ++waiting);
    if (can::is_remote(frame) && (frame.id & 0x7E0U) == 0x060) waiting = 0;  // the answer says that all have gone
    answer(frame);
  };
  rig.wait.on_wait = [&] {
    waiting = 0;
    rig.advance();
  };
  EXPECT_EQ(rig.start(), "accepted");
  EXPECT_LE(most, 10);
}

/// After a fault, one drive ignores all commands and still makes the old torque; then the operator asks for a reset
/// (kEnable). A reset sends zero torques in every period. The drive would ignore these as well, but they would feed its
/// watchdog, so it would keep its torque. So the firmware must stay silent until all drives have said that they are
/// off, and reset them only then.
TEST(OdriveInOperation, AResetWaitsUntilAllDrivesAreOff) {
  OdriveHand rig({.has_old_watchdog = true}, {.has_old_watchdog = true});
  ASSERT_EQ(rig.start(), "accepted");
  ASSERT_TRUE(rig.enable());
  (void)rig.period(rt::DriveRequest::kOperate, 0.1);
  rig.nodes[2].obeys = false;
  (void)rig.period(rt::DriveRequest::kHold);
  for (int i = 0; i < 23; ++i) (void)rig.period(rt::DriveRequest::kEnable);
  EXPECT_EQ(rig.torque(), 0.0F);
  rig.nodes[2].obeys = true;
  EXPECT_TRUE(rig.enable());
}

/// A drive whose power was switched off and on is back in its stored mode, and start-up has not tested its watchdog
/// since. So it must stay off until the controller is started again.
TEST(OdriveInOperation, APowerCycledDriveStaysOffUntilARestart) {
  test::Random random(13);
  for (int i = 0; i < 20; ++i) {
    OdriveHand rig({.starts_in_closed_loop = i % 2 == 1, .obeys_idle = true});
    ASSERT_EQ(rig.start(), "accepted");
    ASSERT_TRUE(rig.enable());
    for (long k = random.any(0, 30); k > 0; --k) (void)rig.period(rt::DriveRequest::kOperate);
    rig.nodes[2].power_cycle(rig.wait.time, milliseconds(random.any(50, 400)));
    int ticks = 0;
    while (!rig.period(rt::DriveRequest::kOperate, 0.1).drive_fault && ticks < 100) ++ticks;
    EXPECT_LE(ticks, 33) << "three heartbeats";
    for (int k = 0; k < 20; ++k) (void)rig.period(rt::DriveRequest::kHold);
    EXPECT_EQ(rig.torque(), 0.0F);
    EXPECT_FALSE(rig.enable(600));
    EXPECT_TRUE(rig.is_off());
    EXPECT_EQ(rig.drives.configure(rig.wait).value_or("").find("a drive's heartbeat stayed away"), 0U);
  }
}

/// Every drive is told its mode and its limits before it is switched on again.
TEST(OdriveInOperation, ModeAndLimitsGoBeforeEveryClosedLoop) {
  OdriveHand rig;
  ASSERT_EQ(rig.start(), "accepted");
  for (int times = 0; times < 3; ++times) {
    rig.bus.sent.clear();
    ASSERT_TRUE(rig.enable());
    for (std::uint32_t node = 1; node <= 3; ++node) {
      std::string order;
      for (const can::Frame& f : rig.bus.sent) {
        if (f.id == (node << 5U | 0x0BU)) order += f.data[0] == 1 && f.data[4] == 1 ? 'm' : '?';
        if (f.id == (node << 5U | 0x0FU)) order += 'l';
        if (f.id == (node << 5U | 0x07U)) order += f.data[0] == 8 ? 'c' : 'i';
      }
      EXPECT_EQ(order, "mlc") << node;
    }
    EXPECT_LE(rig.torque(), 0.0F);
    for (int i = 0; i < 40; ++i) (void)rig.period(rt::DriveRequest::kHold);
    EXPECT_TRUE(rig.is_off());
  }
}

/// A drive that reports an error and no error within the same period must still be reported as faulty. In the same way
/// a drive that was off for a part of a period must be reported as not enabled.
TEST(OdriveInOperation, AnErrorOfOneHeartbeatIsSeen) {
  OdriveHand rig;
  ASSERT_EQ(rig.start(), "accepted");
  ASSERT_TRUE(rig.enable());
  EXPECT_FALSE(rig.period(rt::DriveRequest::kOperate).drive_fault);
  rig.bus.inbox.push_back({0x041, 8, {0x20, 0, 0, 0, 8}});
  rig.bus.inbox.push_back({0x041, 8, {0, 0, 0, 0, 8}});
  EXPECT_TRUE(rig.period(rt::DriveRequest::kOperate).drive_fault);
  rig.bus.inbox.push_back({0x041, 8, {0, 0, 0, 0, 1}});
  rig.bus.inbox.push_back({0x041, 8, {0, 0, 0, 0, 8}});
  EXPECT_FALSE(rig.period(rt::DriveRequest::kOperate).enabled);
  EXPECT_TRUE(rig.period(rt::DriveRequest::kOperate).enabled);
}

/// Each frame of the buttons is used for one period only. So one wrong frame ("dead-man not pressed") is one wrong
/// sample, even if the next frames are lost, and must not make the firmware believe that the dead-man was released and
/// pressed again.
TEST(OdriveInOperation, OneWrongFrameOfTheButtonsIsNoRelease) {
  test::Random random(14);
  OdriveHand rig;
  ASSERT_EQ(rig.start(), "accepted");
  ASSERT_TRUE(rig.enable());
  control::DeadMan dead_man;
  int released = 0;
  for (int i = 0; i < 500; ++i) {
    const bool wrong = i % 10 == 0;
    rig.buttons.bits = wrong ? 0 : 2;
    rig.buttons.answers = wrong || random.happens(0.8);
    const auto r = rig.period(rt::DriveRequest::kOperate);
    if (r.age_ticks != 0) continue;
    dead_man.see(r.dead_man);
    released += r.dead_man ? 0 : 1;
    EXPECT_FALSE(dead_man.counts());
  }
  EXPECT_GT(released, 10);
  EXPECT_LE(released, 50) << "as many as there were wrong frames";
}

/// The button module stops: it sends nothing any more, or frames whose counter stands still. In both cases the samples
/// become old; in the second one the buttons are also reported as stuck.
TEST(OdriveInOperation, AModuleThatFallsAsleepIsFound) {
  for (const bool sends : {false, true}) {
    OdriveHand rig;
    ASSERT_EQ(rig.start(), "accepted");
    ASSERT_TRUE(rig.enable());
    rig.buttons.answers = sends;
    rig.buttons.counts = false;
    rt::HandReading r;
    for (int i = 0; i < 12; ++i) r = rig.period(rt::DriveRequest::kOperate);
    EXPECT_GE(r.age_ticks, 12);
    EXPECT_EQ(r.buttons_stuck, sends);
  }
}

}  // namespace
}  // namespace ligature::platform
