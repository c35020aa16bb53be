#pragma once
// Plays the recorded hand motion of a session through the physics again and compares the result.

#include <filesystem>
#include <string>
#include <vector>

#include "host/lab/rerun/differences.hpp"
#include "host/lab/rerun/recorded_run.hpp"

namespace ligature::lab {

struct RerunOptions {
  std::string log{};
  std::vector<std::string> overrides{};
  bool cuts = true;                ///< end ticks early where the recorded ones ran out of time
  int session = 0;                 ///< number from 1; 0: the only one
  std::filesystem::path folder{};  ///< folder for output files; empty: none are written
};

struct RerunOutcome {
  Differences differences;
  std::int64_t ticks = 0;  ///< ticks of the session in the log
  double period_s = 0.001;
  std::int64_t unknown_ticks = 0;  ///< ticks for which the thread's state is unknown, because records are missing
  std::string why_unknown;         ///< why the state became unknown the last time
  std::int64_t shapes_alone = 0;   ///< recorded shapes of such ticks, which have nothing to compare with
  bool interrupted = false;        ///< stopped by SIGINT or SIGTERM before the end
};

/// Runs to the end or to a stop signal, and writes DIR/rerun.lcmlog, forces.csv and shapes.csv.
/// @throws Refusal when the recording or the settings are refused; nothing has been written then.
[[nodiscard]] RerunOutcome rerun(const RerunOptions& options);

}  // namespace ligature::lab
