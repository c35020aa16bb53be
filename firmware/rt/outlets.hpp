#pragma once
// The real-time thread's edges to the other threads, all of them.

#include <atomic>

#include "firmware/rt/command.hpp"
#include "firmware/rt/latest_value.hpp"
#include "firmware/rt/spsc_ring.hpp"
#include "firmware/rt/tick_record.hpp"

namespace ligature::rt {

struct Outlets {
  static constexpr std::size_t kRecords = 8192;  ///< 8 s of slack for a telemetry thread that is held up

  SpscRing<TickRecord> records{kRecords};  ///< real time -> telemetry, one a period
  LatestValue<ThreadSnapshot> shape;       ///< real time -> telemetry
  SpscRing<Command> commands{64};          ///< telemetry -> real time
  std::atomic<bool> stop{false};           ///< main -> real time: ramp down and end
};

}  // namespace ligature::rt
