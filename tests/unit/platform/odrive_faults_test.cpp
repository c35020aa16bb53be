// What happens to the torque of ODrives when something goes wrong: the real control law and protocol class, simulated
// drives. docs/drives.md has the results.
#include <gtest/gtest.h>

#include <cstdio>
#include <functional>
#include <numbers>

#include "tests/unit/control/controller_rig.hpp"
#include "tests/unit/platform/odrive_hand.hpp"

namespace ligature::platform {
namespace {

using control::Fault;

/// The left hand has ODrives; the right one needs none.
class OdriveRig {
 public:
  explicit OdriveRig(bool old)
      : left({.has_old_watchdog = old}, {.has_old_watchdog = old}), law(control::Rig::scene(), left.device) {
    for (std::size_t j = 0; j < 3; ++j)
      left.nodes[j].position_rev = static_cast<float>(law.in.reading.hand[1].q_rad[j] / (2.0 * std::numbers::pi));
    left.buttons.bits = 0;
    left.wait.on_wait = [this] {
      left.advance();
      if (left.torque() > 0.0F) pushed_at = left.wait.time;
    };
  }
  void period() {
    if (!is_silent) left.drives.request();
    const Nanoseconds end = left.wait.time + std::chrono::milliseconds(1);
    while (left.wait.time < end) {
      left.wait.wait(end);
      if (!is_silent) left.drives.drain();
    }
    if (is_silent) return;
    law.in.reading.hand[0] = left.drives.reading();
    for (std::size_t h = 0; h < 2; ++h) law.in.grasp[h].p_WG = law.controller.hand(h).p_WT + control::Vec3(0, 0, 0.05);
    const auto command = law.controller.tick(law.in);
    ++law.in.tick;
    left.drives.write(command.hand[0]);
  }
  void periods(int n) {
    for (int i = 0; i < n; ++i) period();
  }

  OdriveHand left;
  control::Rig law;
  Nanoseconds pushed_at{0};  // the last time at which a motor had torque
  bool is_silent = false;    // the controller has died
};

TEST(OdriveFaults, EveryCauseEndsTheTorqueInTime) {
  struct Row {
    const char* cause;
    std::function<void(OdriveRig&)> happens;
    Fault fault;
    int within_ms;
  };
  const Row rows[] = {
      {"dead-man released", [](OdriveRig& rig) { rig.left.buttons.bits = 0; }, Fault::kNone, 65},
      {"a drive's fault", [](OdriveRig& rig) { rig.left.nodes[0].fail(); }, Fault::kDriveFault, 12},
      {"a drive's fault, while another one obeys nothing",
       [](OdriveRig& rig) {
         rig.left.nodes[0].fail();
         rig.left.nodes[2].obeys = false;
       },
       Fault::kDriveFault, 33},
      {"a drive's power fails",
       [](OdriveRig& rig) { rig.left.nodes[2].power_cycle(rig.left.wait.time, std::chrono::seconds(1)); },
       Fault::kTpdoTooOld, 22},
      {"the cable is cut", [](OdriveRig& rig) { rig.left.is_cut = true; }, Fault::kTpdoTooOld, 22},
      {"the controller dies", [](OdriveRig& rig) { rig.is_silent = true; }, Fault::kNone, 22},
      {"another controller sends a torque",
       [](OdriveRig& rig) {
         rig.left.bus.inbox.push_back({0x02E, 4, {}});
       },
       Fault::kForeignTorque, 2},
      {"another controller sends a torque to all nodes",
       [](OdriveRig& rig) {
         rig.left.bus.inbox.push_back({0x7EE, 4, {}});
       },
       Fault::kForeignTorque, 2},
      {"the button module is silent", [](OdriveRig& rig) { rig.left.buttons.answers = false; }, Fault::kTpdoTooOld, 22},
      {"the button module repeats its last frame", [](OdriveRig& rig) { rig.left.buttons.counts = false; },
       Fault::kButtonsStuck, 12},
  };
  const auto measure = [](const Row& row, bool old) {
    OdriveRig rig(old);
    ASSERT_EQ(rig.left.start(), "accepted") << row.cause;
    rig.periods(150);
    rig.left.buttons.bits = 2;
    rig.periods(850);
    ASSERT_GT(rig.left.torque(), 0.0F) << row.cause;
    const Nanoseconds onset = rig.left.wait.time;
    row.happens(rig);
    rig.periods(300);
    const double ms = std::chrono::duration<double, std::milli>(rig.pushed_at - onset).count();
    std::printf("%-50s fault %2d, torque for %.1f ms%s\n", row.cause, static_cast<int>(rig.law.controller.fault()), ms,
                old ? ", every frame feeds the watchdog" : "");
    EXPECT_EQ(rig.law.controller.fault(), row.fault) << row.cause;
    EXPECT_LE(ms, row.within_ms) << row.cause;
    EXPECT_EQ(rig.left.torque(), 0.0F) << row.cause;
  };
  for (const Row& row : rows)
    for (const bool old : {false, true}) measure(row, old);
}

}  // namespace
}  // namespace ligature::platform
