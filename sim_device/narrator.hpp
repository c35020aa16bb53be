#pragma once
// Tells on stdout what happens to a hand: connections, script, watchdogs; on a terminal also how far the script is.

#include <string>

#include "sim_device/hand_device.hpp"

namespace ligature::sim {

class Narrator {
 public:
  explicit Narrator(std::string hand);
  /// Prints what changed since the last call; cheap when nothing did.
  void look(const HandDevice& device, int clients, Time now);
  void say(const std::string& what) const;

 private:
  std::string hand_;
  bool is_terminal_;
  int clients_ = 0;
  bool started_ = false, done_ = false, faulted_ = false;
  Time next_progress_{};
};

}  // namespace ligature::sim
