#pragma once
// Statistics of a simulated hand's run.

#include <string>

#include "sim_device/event_loop.hpp"
#include "sim_device/hand_device.hpp"

namespace ligature::sim {

/// JSON with one field per line and units in the names; stats_file.cpp explains the fields.
[[nodiscard]] std::string stats_json(const std::string& hand, const HandDevice& device, const LoopStats& loop,
                                     long dropped_frames);

/// Why a file cannot be created at path, or empty. Checked before the run, so that its results are not lost. Only
/// regular files are replaced (no devices, pipes or folders); symbolic links are followed.
[[nodiscard]] std::string objection_to(const std::string& path);

/// Writes the file completely or not at all, by a temporary file and a rename. @return false on failure.
[[nodiscard]] bool write_file(const std::string& path, const std::string& text);

}  // namespace ligature::sim
