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

/// The knot of the recorded thread from a time on.
struct KnotSpan {
  double from_s = 0.0;
  std::string type;        // "0_1", "3_1", .., "unknown"
  std::string handedness;  // "right", "left", "amphichiral", "mixed", "none"
};

/// Everything `report` prints, gathered in one pass over a log.
struct LogSummary {
  RigFacts facts;
  SessionTally tally;
  TickStatistics ticks;
  std::vector<KnotSpan> knots;  // changes over time, oldest first
  std::optional<ligature_msg::status_t> last_status;
  std::int64_t unreadable_messages = 0, shapes = 0;
  std::string damage;  // of the log, empty for a sound one

  /// Time on the controller's clock that the recorded ticks span, summed over sessions.
  [[nodiscard]] double duration_s() const;
  /// When the knot the log ends with was seen first, and since when it has held; -1 without a shape.
  [[nodiscard]] double knot_first_s() const;
  [[nodiscard]] double knot_since_s() const { return knots.empty() ? -1.0 : knots.back().from_s; }
};

/// @param knot_every_s thread shapes closer together than this are not named. @throws BadInput, RunFailed (stopped).
[[nodiscard]] LogSummary summarise(const std::string& log_path, double knot_every_s = 0.1);

}  // namespace ligature::host
