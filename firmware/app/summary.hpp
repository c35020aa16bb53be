#pragma once

#include <chrono>
#include <cstdint>
#include <string>

#include "firmware/rt/cycle_timing.hpp"

namespace ligature::app {

/// Tick records that did not reach their readers.
struct Losses {
  std::uint64_t telemetry = 0;  ///< records missing in LCM telemetry
  bool recorder = false;        ///< whether there is a flight recorder
  std::int64_t flight = 0;      ///< records missing in the flight recorder
  std::chrono::milliseconds slowest_sync{0};
};

/// The table that is printed at the end of a run: the loop's rate, deadline misses, and times of the phases.
[[nodiscard]] std::string summary(const rt::CycleTiming& timing, std::int64_t periods, const Losses& losses);

}  // namespace ligature::app
