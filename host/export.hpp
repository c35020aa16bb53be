#pragma once
#include <cstdint>
#include <string>

#include "host/export_csv.hpp"

namespace ligature::host {

/// Where to write; an empty name is not written.
struct ExportTargets {
  CsvTargets csv{};
  std::string hdf5{}, mcap{};
};

struct ExportResult {
  std::int64_t tick_rows = 0, shapes = 0, duplicates_left_out = 0, unreadable_messages = 0;
  std::int64_t left_out = 0;  // ticks of more sessions than are kept apart
  std::int64_t missing = 0;   // ticks between the first and the last of a session
  std::string missing_ticks;  // "100..119, 400"; the first holes by number
  std::string damage;         // of the log, empty for a sound one
};

/// What the columns mean, for --help.
[[nodiscard]] std::string forces_columns_help();
[[nodiscard]] std::string ticks_columns_help();
[[nodiscard]] std::string shape_columns_help();

/// Writes tables and files of an LCM log (front to back in constant memory) or of a flight recorder file (which holds
/// ticks and no shapes). Each tick number of a session once, in order (TickOrder). Each file appears complete or not at
/// all. @throws BadInput for a file that is neither or holds no tick; RunFailed for a full disk or a stop request.
ExportResult export_recording(const std::string& log_path, const ExportTargets& targets);

}  // namespace ligature::host
