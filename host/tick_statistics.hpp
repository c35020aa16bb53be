#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "host/thread_time.hpp"
#include "ligature_msg/tick_t.hpp"

namespace ligature::host {

/// Force statistics of one hand.
struct HandStatistics {
  double peak_N = 0.0;  // largest force at the device
  std::int64_t peak_tick = -1;
  double sum_N = 0.0;  // sum of the force at the device over the ticks with a grasp
  std::int64_t grasp_ticks = 0;
  std::int64_t limited_ticks = 0;  // force reduced by a limit
  [[nodiscard]] double mean_N() const { return grasp_ticks ? sum_N / static_cast<double>(grasp_ticks) : 0.0; }
};

/// How well the thread's physics kept up with real time.
struct ThreadStatistics {
  std::int64_t by_work = 0, by_clock = 0;  // ticks cut short: work budget used up, time over
  std::int64_t late = 0;                   // ticks that the physics had not finished when the next samples came
  double lost_ticks = 0.0;                 // time lost, in ticks: the thread was not moved
};

struct FaultEntry {
  std::int64_t tick = 0;
  std::int16_t fault = 0;
};

/// p50, p99 and largest value of one duration, ns.
struct Percentiles {
  std::int32_t p50_ns = 0, p99_ns = 0, max_ns = 0;
};

/// Statistics of timing and forces over ticks. All durations are stored (16 bytes a tick, 58 MB an hour), so that
/// percentiles are exact. A lost period repeats the values of the last executed one: it counts as a period, but not as
/// a sample.
class TickStatistics {
 public:
  void add(const ligature_msg::tick_t& tick);

  /// Call before the ticks of another session: a fault that is still latched then counts again.
  /// @param samples_earliest_ns as in ThreadTime::start_session().
  void start_session(std::int64_t samples_earliest_ns = 0) {
    last_fault_ = 0;
    thread_time_.start_session(samples_earliest_ns);
  }

  [[nodiscard]] std::int64_t executed() const { return static_cast<std::int64_t>(wakeup_ns_.size()); }
  [[nodiscard]] std::int64_t periods_lost() const { return periods_lost_; }
  [[nodiscard]] std::int64_t deadline_misses() const { return deadline_misses_; }
  [[nodiscard]] const ThreadStatistics& thread() const { return thread_; }
  [[nodiscard]] const ThreadTime& thread_time() const { return thread_time_; }
  [[nodiscard]] const std::array<HandStatistics, 2>& hands() const { return hands_; }
  /// One entry each time the fault number changes to another fault.
  [[nodiscard]] const std::vector<FaultEntry>& faults() const { return faults_; }
  [[nodiscard]] Percentiles wakeup() const { return percentiles_of(wakeup_ns_); }
  [[nodiscard]] Percentiles control() const { return percentiles_of(control_ns_); }
  [[nodiscard]] Percentiles execution() const { return percentiles_of(execution_ns_); }

 private:
  static Percentiles percentiles_of(std::vector<std::int32_t> samples);
  void add_thread(const ligature_msg::tick_t& tick);
  void add_hand(std::size_t hand, const ligature_msg::tick_t& tick);

  std::vector<std::int32_t> wakeup_ns_, control_ns_, execution_ns_;
  std::int64_t periods_lost_ = 0, deadline_misses_ = 0;
  ThreadStatistics thread_;
  ThreadTime thread_time_;
  std::array<HandStatistics, 2> hands_;
  std::vector<FaultEntry> faults_;
  std::int16_t last_fault_ = 0;
};

/// Euclidean norm.
[[nodiscard]] double magnitude(const double (&f)[3]);

}  // namespace ligature::host
