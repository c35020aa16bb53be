#pragma once
// One run of the firmware in an LCM log: what a rerun must know before its first tick.

#include <cstdint>
#include <string>
#include <vector>

#include "host/lab/rerun/thread_player.hpp"

namespace ligature::lab {

/// A scene as the recording tells it, in force from that tick on.
struct RecordedSceneText {
  std::int64_t first_tick = 0;
  std::string file, toml;
};

struct RecordedRun {
  std::int64_t session = 0, ticks = 0;
  std::size_t sessions = 0;  ///< in the log
  double period_s = 0.001;
  std::string firmware_version;
  std::vector<RecordedSceneText> scenes;  // in order
};

/// Reads the log once. @param number of the session, from 1; 0: the only one.
/// @throws Refusal with one line that says what the recording lacks, and from when on it is recorded.
[[nodiscard]] RecordedRun survey(const std::string& log, int number);

/// The scenes with other overrides on top, each proved to be one that the physics takes. @throws Refusal.
[[nodiscard]] std::vector<PlayedScene> scenes_of(const std::string& log, const RecordedRun& run,
                                                 const std::vector<std::string>& overrides);

}  // namespace ligature::lab
