#pragma once
// A recording's hands played through the physics once more, and what came of it.

#include <filesystem>
#include <string>
#include <vector>

#include "host/lab/rerun/differences.hpp"
#include "host/lab/rerun/recorded_run.hpp"

namespace ligature::lab {

struct RerunOptions {
  std::string log{};
  std::vector<std::string> overrides{};
  bool cuts = true;                ///< the clock's cuts are done again
  int session = 0;                 ///< from 1; 0: the only one
  std::filesystem::path folder{};  ///< of the files; empty: none
};

struct RerunOutcome {
  Differences differences;
  std::int64_t ticks = 0;  ///< of the run in the log
  double period_s = 0.001;
  std::int64_t unknown_ticks = 0;  ///< in which it is not known how the thread lay
  std::string why_unknown;         ///< the last time
  std::int64_t shapes_alone = 0;   ///< recorded ones of ticks that are not known
  bool interrupted = false;        ///< by SIGINT or SIGTERM before its end
};

/// Plays to the end or to a stop signal, and writes DIR/rerun.lcmlog, forces.csv and shapes.csv.
/// @throws Refusal, before anything is written when the recording or the settings are refused.
[[nodiscard]] RerunOutcome rerun(const RerunOptions& options);

}  // namespace ligature::lab
