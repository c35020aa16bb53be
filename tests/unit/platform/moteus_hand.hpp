#pragma once
// One hand with three simulated moteus drives and a button module, in simulated time.

#include "firmware/platform/moteus_drives.hpp"
#include "sim_device/moteus_node.hpp"
#include "tests/unit/platform/simulated_hand.hpp"

namespace ligature::platform {

class MoteusHand : public SimulatedHand<sim::MoteusNode, MoteusDrives> {
 public:
  explicit MoteusHand(const sim::MoteusSettings& third = {}, const sim::MoteusSettings& others = {})
      : SimulatedHand("moteus.toml", {.request = can::kExtendedBit | 0x8003U, .id = 0x400, .echoes = true}) {
    for (std::uint32_t node = 1; node <= 3; ++node) nodes.emplace_back(node, node == 3 ? third : others);
  }
};

}  // namespace ligature::platform
