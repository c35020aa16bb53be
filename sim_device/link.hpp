#pragma once
// Interface of the links by which LCM messages reach a simulated hand while it runs: targets from a page, or the state
// of the rig.

#include <string>
#include <vector>

#include "sim_device/mechanics.hpp"

namespace ligature::sim {

class Link {
 public:
  Link() = default;
  virtual ~Link() = default;
  Link(const Link&) = delete;
  Link& operator=(const Link&) = delete;

  /// Applies the messages that have arrived. Called in each turn of the device's loop; never waits.
  virtual void look(const Mechanics& mechanics, Time now) = 0;
  /// Lines to print, collected since the last call.
  [[nodiscard]] virtual std::vector<std::string> news() { return {}; }
};

}  // namespace ligature::sim
