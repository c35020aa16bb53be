#pragma once
// One hand with three simulated ODrives and a button module, in simulated time.

#include "firmware/platform/odrive_drives.hpp"
#include "sim_device/odrive_node.hpp"
#include "tests/unit/platform/simulated_hand.hpp"

namespace ligature::platform {

class OdriveHand : public SimulatedHand<sim::OdriveNode, OdriveDrives> {
 public:
  explicit OdriveHand(const sim::OdriveSettings& third = {}, const sim::OdriveSettings& others = {})
      : SimulatedHand("odrive.toml", {.request = can::kRemoteBit | 0x069U, .id = 0x201}) {
    for (std::uint32_t node = 1; node <= 3; ++node) nodes.emplace_back(node, node == 3 ? third : others, wait.time);
  }
};

}  // namespace ligature::platform
