#pragma once
// The real-time thread's edges to the other threads, all of them.

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
  static constexpr std::size_t kRecords = 8192;  ///< 8 s of slack for a telemetry thread that is held up

  SpscRing<TickRecord> records{kRecords};  ///< real time -> telemetry, one a period
  SpscRing<TickRecord>* flight = nullptr;  ///< real time -> flight recorder, the same ones; set before the loop starts
  LatestValue<ThreadSnapshot> shape;       ///< real time -> telemetry
  SpscRing<Command> commands{64};          ///< telemetry -> real time
  std::atomic<bool> stop{false};           ///< main -> real time: ramp down and end

  /// Real time only: one record to everybody who wants one. Nobody who is slow takes it from another.
  void tell(const TickRecord& record) noexcept {
    records.push(record);
    if (flight != nullptr) flight->push(record);
  }
  /// Real time only: records that no ring had room for and that were not even tried.
  void count_untold(std::uint64_t n) noexcept {
    records.count_dropped(n);
    if (flight != nullptr) flight->count_dropped(n);
  }
  /// How many records there is room for at all.
  [[nodiscard]] std::size_t room() const noexcept {
    return flight != nullptr ? std::max(flight->capacity(), records.capacity()) : records.capacity();
  }
};

}  // namespace ligature::rt
