#pragma once

#include <cstdint>
#include <string>

#include "firmware/rt/cycle_timing.hpp"

namespace ligature::app {

/// The last words of a run: how well the rate was held, as a table of fixed width.
[[nodiscard]] std::string summary(const rt::CycleTiming& timing, std::int64_t periods, std::uint64_t records_dropped);

}  // namespace ligature::app
