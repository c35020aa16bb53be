#pragma once
// Derives events from tick records; the real-time thread itself sends no events.

#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

#include "firmware/rt/period.hpp"
#include "firmware/rt/tick_record.hpp"
#include "ligature_msg/event_t.hpp"

namespace ligature::telemetry {

/// Functions that name states and faults. They are passed in because the names belong to the control law, which
/// telemetry does not depend on.
struct Names {
  const char* (*state)(int number);
  const char* (*fault)(int number);
  bool (*stays)(int fault) = [](int) { return false; };  ///< whether the fault cannot be reset
};

/// Compares each record with the one before it.
class EventFinder {
 public:
  explicit EventFinder(const Names& names) : names_(names) {}

  /// @return events: state changes, a new fault, grasps, releases, forces that begin to be limited, and what a rig that
  /// stays in OFF or CALIBRATE waits for. The sender fills in `utime`. Lost periods repeat old values, so they give no
  /// events.
  [[nodiscard]] std::vector<ligature_msg::event_t> next(const rt::TickRecord& record);

 private:
  static constexpr std::int64_t kTicksPerSecond = std::chrono::seconds(1) / rt::kPeriod;
  static constexpr std::int64_t kFirstWord = 3 * kTicksPerSecond, kNextWord = 30 * kTicksPerSecond;
  [[nodiscard]] std::string find_wait(const rt::TickRecord& record);

  Names names_;
  rt::TickRecord last_{};
  std::int64_t since_tick_ = 0;               // first tick of the present state
  std::int64_t next_word_tick_ = kFirstWord;  // when to say what the rig waits for
};

}  // namespace ligature::telemetry
