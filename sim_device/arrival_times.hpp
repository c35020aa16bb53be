#pragma once
// When frames came that were read late. The simulated wire must not be slow because this process was: frames that piled
// up in the socket get back the beat they were sent with.

#include <algorithm>
#include <span>
#include <vector>

#include "protocol/can/nmt.hpp"
#include "sim_device/deadline.hpp"
#include "sim_device/port.hpp"

namespace ligature::sim {

/// Arrival times of what one client sent between two looks at its socket. With at most one SYNC among them all came
/// now. With n SYNCs, whole periods were slept through: the last SYNC came now, each one before it a period earlier,
/// and every frame with the SYNC it follows; never before `last_look`. Times do not decrease.
[[nodiscard]] inline std::vector<Time> arrival_times(std::span<const Received> frames, Time last_look, Time now,
                                                     Time period) {
  auto to_come = std::count_if(frames.begin(), frames.end(), [](const Received& r) { return can::is_sync(r.frame); });
  if (to_come <= 1) return std::vector<Time>(frames.size(), now);
  std::vector<Time> times;
  Time at = std::max(last_look, now - period * to_come);
  for (const Received& r : frames) {
    if (can::is_sync(r.frame)) at = std::max(last_look, now - period * --to_come);
    times.push_back(at);
  }
  return times;
}

}  // namespace ligature::sim
