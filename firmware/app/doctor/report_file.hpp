#pragma once
// The file that `doctor --report` writes.

#include <string>

#include "firmware/app/doctor/report.hpp"

namespace ligature::app {

/// Why no report can be written to `path`; empty: one can. The report is renamed to this name, which would turn a
/// device or a pipe into a regular file.
[[nodiscard]] std::string objection_to_report(const std::string& path);

/// Writes the whole report or nothing, so that nobody ever reads half a report; an older report stays until then.
/// @return false for nothing.
[[nodiscard]] bool write_report(const std::string& path, const DoctorReport& report);

}  // namespace ligature::app
