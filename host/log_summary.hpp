#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "host/rig_facts.hpp"
#include "host/session_tally.hpp"
#include "host/tick_statistics.hpp"
#include "ligature_msg/status_t.hpp"

namespace ligature::host {

/// The knot of the recorded thread from `from_s` until the next entry.
struct KnotSpan {
  double from_s = 0.0;
  std::string type;        // "0_1", "3_1", .., "unknown"
  std::string handedness;  // "right", "left", "amphichiral", "mixed", "none"
};

/// Everything that `report` prints, collected in one pass over a log.
struct LogSummary {
  RigFacts facts;
  SessionTally tally;
  TickStatistics ticks;
  std::vector<KnotSpan> knots;  // changes over time, oldest first
  std::optional<ligature_msg::status_t> last_status;
  std::int64_t unreadable_messages = 0, shapes = 0;
  std::string damage;  // one line about damaged parts of the log; empty when it is intact

  /// Time on the controller's clock from the first to the last tick, summed over sessions.
  [[nodiscard]] double duration_s() const;
  /// Time at which the final knot first occurred, and time from which on it persisted without interruption; -1 without
  /// a shape.
  [[nodiscard]] double knot_first_s() const;
  [[nodiscard]] double knot_since_s() const { return knots.empty() ? -1.0 : knots.back().from_s; }
  /// The last knot before the thread became unknotted. nullptr: there was none, or the last recorded shape has a knot.
  [[nodiscard]] const KnotSpan* untied() const;
  /// Whether the final knot was tied within the recording, and not there in its first shape already.
  [[nodiscard]] bool was_tied() const;
};

/// @param knot_every_s smallest time between two shapes whose knot is named.
/// @throws BadInput, RunFailed (stop signal).
[[nodiscard]] LogSummary summarise(const std::string& log_path, double knot_every_s = 0.1);

}  // namespace ligature::host
