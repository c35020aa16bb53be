#pragma once

#include <chrono>
#include <cstdint>
#include <string>

#include "firmware/rt/cycle_timing.hpp"

namespace ligature::app {

/// Records that were lost on their way out of the loop.
struct Losses {
  std::uint64_t telemetry = 0;  ///< of what LCM hears
  bool recorder = false;        ///< whether there is a flight recorder
  std::int64_t flight = 0;      ///< of what it holds
  std::chrono::milliseconds slowest_sync{0};
};

/// The last words of a run: how well the rate was held, as a table of fixed width.
[[nodiscard]] std::string summary(const rt::CycleTiming& timing, std::int64_t periods, const Losses& losses);

}  // namespace ligature::app
