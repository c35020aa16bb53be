#pragma once
#include <string>

#include "host/csv_row.hpp"
#include "ligature_msg/thread_t.hpp"
#include "ligature_msg/tick_t.hpp"

namespace ligature::host {

/// The three tables of `export`: header line, and one row of values in the header's order.
/// @param row scratch buffer, empty before and after the call. @param session number of the firmware run in the
/// recording: 1, 2, .. in order of appearance.
[[nodiscard]] std::string forces_header();
[[nodiscard]] const std::string& forces_row(CsvRow& row, const ligature_msg::tick_t& tick, double t_s, int session);

[[nodiscard]] std::string ticks_header();
[[nodiscard]] const std::string& ticks_row(CsvRow& row, const ligature_msg::tick_t& tick, double t_s, int session);

[[nodiscard]] std::string shape_header();
[[nodiscard]] const std::string& shape_row(CsvRow& row, const ligature_msg::thread_t& thread, double t_s, int node);

}  // namespace ligature::host
