#pragma once
// One session (run of the firmware) of an LCM log, with the facts that a rerun needs before its first tick.

#include <cstdint>
#include <string>
#include <vector>

#include "host/lab/rerun/thread_player.hpp"

namespace ligature::lab {

/// A scene from the recording, in force from `first_tick` on.
struct RecordedSceneText {
  std::int64_t first_tick = 0;
  std::string file, toml;
};

struct RecordedRun {
  std::int64_t session = 0, ticks = 0;
  std::size_t sessions = 0;  ///< number of sessions in the log
  double period_s = 0.001;
  std::string firmware_version;
  std::vector<RecordedSceneText> scenes;  // the run's scenes, in order of time
};

/// Reads the log once. @param number of the session, from 1; 0: the log must have only one.
/// @throws Refusal with one line that says which data the recording lacks, and since which version they are recorded.
[[nodiscard]] RecordedRun survey(const std::string& log, int number);

/// The run's scenes with further overrides applied; each has been checked by building its simulation. @throws Refusal.
[[nodiscard]] std::vector<PlayedScene> scenes_of(const std::string& log, const RecordedRun& run,
                                                 const std::vector<std::string>& overrides);

}  // namespace ligature::lab
