#pragma once
// Prints events of a hand to stdout: connections, script, watchdogs; on a terminal also the script's progress.

#include <string>

#include "sim_device/hand_device.hpp"

namespace ligature::sim {

class Narrator {
 public:
  explicit Narrator(std::string hand);
  /// Prints what has changed since the last call; cheap if nothing has.
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
