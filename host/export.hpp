#pragma once
#include <cstdint>
#include <string>

#include "host/export_csv.hpp"
#include "host/export_trace.hpp"

namespace ligature::host {

/// Output files; an empty name means: not written.
struct ExportTargets {
  CsvTargets csv{};
  std::string hdf5{}, mcap{};
  TraceTarget trace{};
};

struct ExportResult {
  std::int64_t tick_rows = 0, shapes = 0, duplicates_left_out = 0, unreadable_messages = 0;
  std::int64_t left_out = 0;  // ticks of sessions beyond SessionTally::kMaxSessions, not exported
  bool has_grasp = false;     // a hand held a node in at least one tick
  std::int64_t missing = 0;   // ticks missing between the first and the last tick of each session, summed
  std::string missing_ticks;  // "100..119, 400": the first missing ranges
  std::string damage;         // one line about damaged parts of the log; empty when it is intact
};

/// Descriptions of the columns, for --help.
[[nodiscard]] std::string forces_columns_help();
[[nodiscard]] std::string ticks_columns_help();
[[nodiscard]] std::string shape_columns_help();

/// Exports an LCM log (read front to back in constant memory) or a flight recorder file (ticks only, no shapes). Every
/// tick number of a session appears once, in rising order (TickOrder). Output files appear complete or not at all.
/// @throws BadInput when the file is of neither kind or holds no tick; RunFailed for a full disk or a stop request.
ExportResult export_recording(const std::string& log_path, const ExportTargets& targets);

}  // namespace ligature::host
