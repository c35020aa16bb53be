#pragma once
// What a simulated hand says about its run.

#include <string>

#include "sim_device/event_loop.hpp"
#include "sim_device/hand_device.hpp"

namespace ligature::sim {

/// JSON with one unit-suffixed field a line; see stats_file.cpp for the list.
[[nodiscard]] std::string stats_json(const std::string& hand, const HandDevice& device, const LoopStats& loop,
                                     long dropped_frames);

/// Why no file can be made at path, or empty: asked before the run, so that it is not lost after it. What is there and
/// no regular file (a device, a pipe, a folder) is never replaced; a symbolic link is followed.
[[nodiscard]] std::string objection_to(const std::string& path);

/// Writes the whole text or nothing: a file beside it first, then a rename. False when it could not.
[[nodiscard]] bool write_file(const std::string& path, const std::string& text);

}  // namespace ligature::sim
