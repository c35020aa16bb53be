#pragma once
// Makes small flight recorder files for tests.

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "firmware/telemetry/flight_slots.hpp"
#include "host/flight_reader.hpp"
#include "tests/unit/host/synthetic_log.hpp"

namespace ligature::telemetry::test {

inline const FlightFacts kFacts{77, 0.001, 2.5, "1.2.3", "a.toml", "[suture]"};

inline rt::TickRecord record_of(std::int64_t tick) {
  rt::TickRecord record;
  record.tick = tick;
  return record;
}

inline std::unique_ptr<FileDisk> disk_or_die(const std::string& path, std::int64_t slots) {
  auto made = FileDisk::make(path, file_bytes(header_of(kFacts, slots)));
  EXPECT_TRUE(std::holds_alternative<std::unique_ptr<FileDisk>>(made)) << std::get<std::string>(made);
  return std::move(std::get<0>(made));
}

inline std::vector<std::int64_t> ticks_in(const host::FlightReader& reader) {
  std::vector<std::int64_t> ticks;
  reader.visit([&](const auto& tick) { ticks.push_back(tick.tick); });
  return ticks;
}

}  // namespace ligature::telemetry::test
