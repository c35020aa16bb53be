#pragma once
// Reconstructs arrival times of frames that this process read late, so that a delay of the process does not delay the
// simulated bus.

#include <algorithm>
#include <span>
#include <vector>

#include "sim_device/deadline.hpp"
#include "sim_device/port.hpp"

namespace ligature::sim {

/// Arrival times of the frames that a client sent between two reads of its socket. With at most one among them that
/// begins a period (SYNC): all `now`. With n of them the process missed whole periods: the last one arrived now, each
/// earlier one a period before, and every other frame together with the one before it; never earlier than `last_look`.
/// Times do not decrease.
template <class BeginsPeriod>
[[nodiscard]] std::vector<Time> arrival_times(std::span<const Received> frames, Time last_look, Time now, Time period,
                                              BeginsPeriod begins_period) {
  auto to_come = std::count_if(frames.begin(), frames.end(), [&](const Received& r) { return begins_period(r.frame); });
  if (to_come <= 1) return std::vector<Time>(frames.size(), now);
  std::vector<Time> times;
  Time at = std::max(last_look, now - period * to_come);
  for (const Received& r : frames) {
    if (begins_period(r.frame)) at = std::max(last_look, now - period * --to_come);
    times.push_back(at);
  }
  return times;
}

}  // namespace ligature::sim
