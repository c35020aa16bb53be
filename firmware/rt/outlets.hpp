#pragma once
// All channels between the real-time thread and the other threads.

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>

#include "firmware/rt/command.hpp"
#include "firmware/rt/latest_value.hpp"
#include "firmware/rt/spsc_ring.hpp"
#include "firmware/rt/tick_record.hpp"

namespace ligature::rt {

struct Outlets {
  static constexpr std::size_t kRecords = 8192;  ///< 8 s of buffer if the telemetry thread is delayed

  SpscRing<TickRecord> records{kRecords};  ///< real time -> telemetry, one per period
  /// Real time -> flight recorder, the same records; set before the loop starts
  SpscRing<TickRecord>* flight = nullptr;
  LatestValue<ThreadSnapshot> shape;  ///< real time -> telemetry
  SpscRing<Command> commands{64};     ///< telemetry -> real time
  std::atomic<bool> stop{false};      ///< main -> real time: ramp forces down and end

  /// Real-time thread only: sends a record to all readers. A slow reader does not affect another.
  void tell(const TickRecord& record) noexcept {
    records.push(record);
    if (flight != nullptr) flight->push(record);
  }
  /// Real-time thread only: counts records as dropped that were not pushed, because no ring had room for them.
  void count_untold(std::uint64_t n) noexcept {
    records.count_dropped(n);
    if (flight != nullptr) flight->count_dropped(n);
  }
  /// Capacity of the larger ring, in records.
  [[nodiscard]] std::size_t room() const noexcept {
    return flight != nullptr ? std::max(flight->capacity(), records.capacity()) : records.capacity();
  }
};

}  // namespace ligature::rt
