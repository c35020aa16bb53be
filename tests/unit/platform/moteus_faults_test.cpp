// What happens to the torque of moteus drives when something goes wrong: the real control law and protocol class,
// simulated drives. docs/drives.md has the results.
#include <limits>

#include "tests/unit/platform/hand_rig.hpp"
#include "tests/unit/platform/moteus_hand.hpp"

namespace ligature::platform {
namespace {

using control::Fault;
using Rig = HandRig<MoteusHand>;

TEST(MoteusFaults, EveryCauseEndsTheTorqueInTime) {
  const auto another = [](std::uint32_t id) {
    return [id](Rig& rig) {
      can::Frame f = moteus::torque(1, 0.5F, {});
      f.id = id;
      rig.left.bus.inbox.push_back(f);
    };
  };
  const auto late = [](int us) {
    return [us](Rig& rig) {
      for (auto& node : rig.left.nodes) node.settings.answers_after = std::chrono::microseconds(us);
    };
  };
  const Cause<MoteusHand> rows[] = {
      {"dead-man released", [](Rig& rig) { rig.left.buttons.bits = 0; }, Fault::kNone, 65},
      {"a drive's fault", [](Rig& rig) { rig.left.nodes[0].fail(33); }, Fault::kDriveFault, 2},
      {"a drive falls into a fixed voltage", [](Rig& rig) { rig.left.nodes[0].set_mode(6); }, Fault::kDriveFault, 2},
      {"the watchdog of one drive runs out", [](Rig& rig) { rig.left.nodes[0].set_mode(11); }, Fault::kDriveFault, 2},
      {"a drive takes its stored gain", [](Rig& rig) { rig.left.nodes[0].settings.takes_gains = false; },
       Fault::kDriveFault, 8},
      {"a drive does not know its torque",
       [](Rig& rig) { rig.left.nodes[1].adds_Nm = std::numeric_limits<float>::quiet_NaN(); }, Fault::kTorqueAstray, 4},
      {"a drive makes a torque of its own", [](Rig& rig) { rig.left.nodes[1].adds_Nm = 0.2F; }, Fault::kTorqueAstray,
       4},
      {"a drive's fault, while another one obeys nothing",
       [](Rig& rig) {
         rig.left.nodes[0].fail(33);
         rig.left.nodes[2].obeys = false;
       },
       Fault::kDriveFault, 22},
      {"a drive starts anew", [](Rig& rig) { rig.left.nodes[2].power_cycle(rig.left.wait.time, Nanoseconds(0)); },
       Fault::kDriveFault, 2},
      {"a drive's power fails",
       [](Rig& rig) { rig.left.nodes[2].power_cycle(rig.left.wait.time, std::chrono::seconds(1)); }, Fault::kTpdoTooOld,
       22},
      {"all answers come 1.05 ms late", late(1050), Fault::kTpdoTooOld, 22},
      {"all answers come 1.5 ms late", late(1500), Fault::kTpdoTooOld, 22},
      {"all answers come 2.95 ms late", late(2950), Fault::kTpdoTooOld, 22},
      {"all answers come 3.5 ms late", late(3500), Fault::kTpdoTooOld, 22},
      {"the cable is cut", [](Rig& rig) { rig.left.is_cut = true; }, Fault::kTpdoTooOld, 22},
      {"the controller dies, and nothing moves", [](Rig& rig) { rig.is_silent = true; }, Fault::kNone, 22},
      {"another controller sends a torque", another(2), Fault::kForeignTorque, 2},
      {"another controller sends a torque to all nodes", another(0x7F), Fault::kForeignTorque, 2},
      {"the button module is silent", [](Rig& rig) { rig.left.buttons.answers = false; }, Fault::kTpdoTooOld, 22},
      {"the button module repeats its last frame", [](Rig& rig) { rig.left.buttons.counts = false; },
       Fault::kButtonsStuck, 12},
  };
  for (const auto& row : rows) {
    Rig rig;
    measure(rig, row);
  }
}

}  // namespace
}  // namespace ligature::platform
