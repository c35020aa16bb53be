// What happens to the torque of ODrives when something goes wrong: the real control law and protocol class, simulated
// drives. docs/drives.md has the results.
#include "tests/unit/platform/hand_rig.hpp"
#include "tests/unit/platform/odrive_hand.hpp"

namespace ligature::platform {
namespace {

using control::Fault;

TEST(OdriveFaults, EveryCauseEndsTheTorqueInTime) {
  using OdriveRig = HandRig<OdriveHand>;
  const Cause<OdriveHand> rows[] = {
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
  for (const auto& row : rows) {
    for (const bool old : {false, true}) {
      const sim::OdriveSettings settings{.has_old_watchdog = old};
      OdriveRig rig(settings, settings);
      measure(rig, row, old ? ", every frame feeds the watchdog" : "");
    }
  }
}

}  // namespace
}  // namespace ligature::platform
