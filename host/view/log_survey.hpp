#pragma once
#include <atomic>
#include <cstdint>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <thread>
#include <vector>

#include "host/view/log_map.hpp"
#include "host/view/trace_row.hpp"

namespace ligature::host::view {

/// Reads a whole log once in the background while it is already being played. Collects marks to jump to, the knots over
/// time, and the trace bins (smallest and largest values of 50 ticks each) for the page's long time windows.
class LogSurvey {
 public:
  static constexpr std::size_t kMostBins = 864'000 /* 12 h */, kMostMarks = 5'000, kOverview = 600;
  static constexpr double kKnotPeriod_s = 0.2;

  explicit LogSurvey(const LogMap& map);

  [[nodiscard]] double progress() const { return progress_; }  ///< 0 .. 1

  /// Marks {t_s, kind, hand, text} in order of time, and the largest force of each hand, N, in each of kOverview equal
  /// parts of the log. Complete when progress() is 1.
  [[nodiscard]] nlohmann::json marks() const;

  /// Points by which two recordings can be aligned.
  struct Landmarks {
    /// tick numbers; first_grasp: the first tick in which a hand holds a node
    std::optional<std::int64_t> first_tick, first_grasp;
    double first_tick_s = 0.0;  ///< time of first_tick since the log's first message, s
    double period_s = 1e-3;
  };
  [[nodiscard]] Landmarks landmarks() const;

  /// The trace bins of the ten minutes before time t, as far as they belong to the session that runs at t.
  [[nodiscard]] std::vector<TraceBin> history(double t_s) const;

 private:
  struct TimedBin {
    double t_s;
    std::int64_t session;
    TraceBin bin;
  };
  void go(const std::stop_token& stop);
  void take_status(const std::vector<std::byte>& payload);
  void take_batch(double t_s, const std::vector<std::byte>& payload);
  void take_event(double t_s, const std::vector<std::byte>& payload);
  void take_shape(double t_s, const std::vector<std::byte>& payload);
  void add_mark(double t_s, int kind, int hand, const std::string& text);

  const LogMap& map_;
  mutable std::mutex mutex_;
  std::vector<TimedBin> bins_;
  Landmarks landmarks_;
  nlohmann::json marks_ = nlohmann::json::array();
  std::vector<float> overview_[2]{std::vector<float>(kOverview), std::vector<float>(kOverview)};
  BinMaker bin_maker_;
  std::int64_t session_ = -1;
  bool has_period_ = false;
  double knot_due_s_ = 0.0;
  std::string knot_ = "0_1 none";
  std::atomic<double> progress_ = 0.0;
  std::jthread thread_;
};

}  // namespace ligature::host::view
