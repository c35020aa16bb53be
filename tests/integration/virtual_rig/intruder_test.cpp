// A foreign node on a hand's bus, and drives that push by themselves, must be detected in every state; normal errors
// must not be mistaken for either.
#include <gtest/gtest.h>

#include <algorithm>
#include <optional>

#include "firmware/control/faults.hpp"
#include "protocol/can/device_profile.hpp"
#include "protocol/scene/fault_script.hpp"
#include "tests/integration/virtual_rig/scenes.hpp"
#include "tests/integration/virtual_rig/simulated_rig.hpp"
#include "tests/support/random.hpp"

namespace ligature {
namespace {

using control::Fault;
using scene::FaultKind;
using scene::ForeignFrame;

struct Rig : lab::VirtualRig {
  explicit Rig(bool armed, double loss = 0.0, std::uint64_t seed = 1)
      : VirtualRig(lab::RigSetup{.scene = std::get<scene::Scene>(scene::load_scene(kScenes + "paper.toml")),
                                 .settings = {20, armed},
                                 .frame_loss = loss,
                                 .seed = seed},
                   std::get<scene::GripperScript>(scene::load_gripper_script(kScenes + "operators/overhand.csv"))) {}

  [[nodiscard]] bool any_torque() const {
    return std::ranges::any_of(std::array{&left, &right}, [](const DeviceBus* b) {
      return std::ranges::any_of(b->device.torque_permille(), [](auto t) { return t != 0; });
    });
  }
};

/// Ticks from the event to the fault, and to the last torque of any motor.
struct Found {
  Fault fault = Fault::kNone;
  std::int64_t ticks_to_fault = -1, ticks_to_zero = 0;
};

Found found(bool armed, double from_s, scene::FaultScript script) {
  Rig rig(armed);
  script.from_s = from_s;
  rig.left.faults.emplace(script);
  EXPECT_EQ(rig.run(1600), std::nullopt);
  const auto onset = static_cast<std::int64_t>(std::lround(1e3 * from_s));
  Found f{rig.controller.fault()};
  for (const auto& r : rig.records) {
    if (r.fault != 0 && f.ticks_to_fault < 0) f.ticks_to_fault = r.tick - onset;
  }
  for (auto tick = static_cast<std::size_t>(onset); tick < rig.drives_push.size(); ++tick)
    if (rig.drives_push[tick]) f.ticks_to_zero = static_cast<std::int64_t>(tick) - onset;
  return f;
}

/// A foreign node may fill the bus while the master's heartbeat waits in the queue. NMT stop then waits behind the
/// heartbeat, and the drives switch off by themselves when the heartbeat's timeout is over. The test floods the bus in
/// each of the 50 periods between two heartbeats.
TEST(Intruder, AFullBusRarelyHoldsUpTheStopAndNeverTheDrivesOwnWatch) {
  int held_up = 0;
  for (int phase = 0; phase < 50; ++phase) {
    const auto f = found(false, 0.2 + 1e-3 * phase,
                         {.title = {}, .kind = FaultKind::kForeign, .node = 0, .permille = 3000, .period_s = 2e-4});
    EXPECT_EQ(f.fault, Fault::kForeignTorque) << phase;
    EXPECT_LE(f.ticks_to_zero, can::profile::kDefaultHeartbeatTimeout_ms) << phase;
    held_up += f.ticks_to_zero > 3;
  }
  EXPECT_LE(held_up, 1);
}

/// A foreign node sends five RPDOs per period all the time; the stopped drives must ignore them.
TEST(Intruder, WhoKeepsCommandingTorqueGetsNoneInAnyState) {
  for (const bool armed : {false, true}) {
    for (const double from_s : {0.02, 0.2, 0.6, 1.4}) {  // CALIBRATE, IDLE or ENGAGE, ENGAGE, FORCE
      for (const int node : {0, 1, 3}) {
        const auto f =
            found(armed, from_s,
                  {.title = {}, .kind = FaultKind::kForeign, .node = node, .permille = 3000, .period_s = 2e-4});
        EXPECT_EQ(f.fault, Fault::kForeignTorque) << from_s << " " << armed << " " << node;
        EXPECT_LE(f.ticks_to_fault, 2);
        EXPECT_LE(f.ticks_to_zero, 3);
      }
    }
  }
}

TEST(Intruder, ADriveThatPushesByItselfIsFoundInAnyState) {
  for (const bool armed : {false, true}) {
    for (const double from_s : {0.02, 0.2, 1.4}) {
      for (const int node : {1, 2, 3}) {
        for (const int permille : {-900, 900}) {
          const auto f =
              found(armed, from_s, {.title = {}, .kind = FaultKind::kAstray, .node = node, .permille = permille});
          EXPECT_EQ(f.fault, Fault::kTorqueAstray) << from_s << " " << armed << " " << node;
          EXPECT_LE(f.ticks_to_fault, 3) << "acting from one SYNC on, told at the next two";
          EXPECT_LE(f.ticks_to_zero, 4);
        }
      }
    }
  }
}

/// Lost, delayed, duplicated and reordered frames, a restarting drive, and commands to reset and arm: they may cause
/// other faults, but not these.
TEST(Intruder, NoHonestTroubleLooksLikeOne) {
  test::Random random(92);
  const auto any = [&](int below) { return static_cast<int>(random() % static_cast<unsigned>(below)); };
  constexpr FaultKind kTroubles[] = {FaultKind::kLose,    FaultKind::kDelay,  FaultKind::kDuplicate,
                                     FaultKind::kReorder, FaultKind::kReboot, FaultKind::kEmergency};
  for (int run = 0; run < 30; ++run) {
    const std::uint64_t seed = random();
    const double loss = 0.01 * any(21);
    Rig rig(true, loss, seed);
    scene::FaultScript trouble{.title = {},
                               .kind = kTroubles[run % 6],
                               .node = any(4),
                               .share = 0.01 * any(31),
                               .from_s = 1e-3 * any(1500),
                               .delay_s = 1e-4 * any(80),
                               .seed = any(1000)};
    rig.right.faults.emplace(trouble);
    rig.each_tick = [&] {
      const auto tick = rig.records.size();
      if (tick % 200 == 0) rig.outlets->commands.push({0, rt::CommandKind::kResetFault});
      if (tick % 200 == 100) rig.outlets->commands.push({0, rt::CommandKind::kArm});
      if (tick % 700 == 0) rig.outlets->commands.push({0, rt::CommandKind::kStop});
    };
    ASSERT_EQ(rig.run(1500), std::nullopt);
    for (const auto& r : rig.records) {
      ASSERT_FALSE(control::needs_restart(static_cast<Fault>(r.fault)))
          << "fault " << r.fault << " in tick " << r.tick << ", loss " << loss << ", seed " << seed << ", trouble "
          << static_cast<int>(trouble.kind) << " from " << trouble.from_s << " s, share " << trouble.share << ", delay "
          << trouble.delay_s << ", its seed " << trouble.seed;
    }
  }
}

}  // namespace
}  // namespace ligature
