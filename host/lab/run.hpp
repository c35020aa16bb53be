#pragma once
// An offline run: plays a scene, writes tables and a summary.

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "host/lab/rehearsal.hpp"
#include "host/lab/statistics.hpp"

namespace ligature::lab {

struct RunOptions {
  std::filesystem::path folder;
  double duration_s = 10.0;
  double shape_every_s = 0.02;
};

/// Content of summary.json.
struct RunSummary {
  std::string model;
  int nodes = 0;
  std::int64_t ticks = 0;
  double duration_s = 0.0;
  bool finite = true;
  bool interrupted = false;  ///< stopped by SIGINT or SIGTERM before the end
  knot::KnotResult knot;
  /// The knot over time as (time in s, type), from t = 0 on, one entry per change; checked every 20 ms
  std::vector<std::pair<double, std::string>> knot_history;
  double max_stretch = 0.0;
  double min_gap_m = 0.0;
  double max_penetration_diameters = 0.0;
  MaxMean left_N, right_N;  ///< force on the hand in the thread's world, N
  Spread step_us;
  double realtime_factor = 0.0;  ///< simulated time / CPU time spent in ticks
  std::string failure;           ///< empty, or the line with tick, node and likely cause
};

/// Runs to the end, to a stop signal, or to the first non-finite tick (which is not written), and writes trace.csv,
/// shape.csv and summary.json. Those of an earlier run are replaced when the new ones are whole.  @throws Refusal when
/// a file cannot be written.
RunSummary run(Rehearsal& rehearsal, const RunOptions& options);

/// Text of summary.json.
[[nodiscard]] std::string to_json(const RunSummary& summary);

}  // namespace ligature::lab
