#pragma once
// What happened, read out of the records: the real-time thread only states facts, it announces nothing.

#include <string>
#include <vector>

#include "firmware/rt/tick_record.hpp"
#include "ligature_msg/event_t.hpp"

namespace ligature::telemetry {

/// Words for numbers that belong to the control law, which telemetry does not know.
struct Names {
  const char* (*state)(int number);
  const char* (*fault)(int number);
  bool (*stays)(int fault) = [](int) { return false; };  ///< no reset leaves it
};

/// Compares each record with the one before it.
class EventFinder {
 public:
  explicit EventFinder(const Names& names) : names_(names) {}

  /// @return state changes, a new fault, grasps, releases, and forces that begin to be limited; `utime` is left to the
  /// sender. Lost periods hold old values, so they bring nothing.
  [[nodiscard]] std::vector<ligature_msg::event_t> next(const rt::TickRecord& record);

 private:
  Names names_;
  rt::TickRecord last_{};
};

}  // namespace ligature::telemetry
