#pragma once
#include <chrono>
#include <cstdint>
#include <map>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "host/messages.hpp"
#include "host/view/frame.hpp"
#include "host/view/ring.hpp"
#include "host/view/trace_row.hpp"

namespace ligature::host::view {

/// Up to where one page has been told of a picture's traces.
struct TracePlace {
  std::int64_t epoch = -1;  // of the picture; another one means: forget all, start again
  std::int64_t row = 0, bin = 0;
};

/// Up to where one page has been told.
struct Place {
  TracePlace traces, beside;
  std::int64_t event = 0, shape = -1;
  std::map<std::string, std::int64_t> topics;  // versions
  std::uint32_t frame = 0;
};

/// The rig as last heard: what every page is drawn from. Written by the thread that hears LCM or plays a recording and
/// by the one that names knots, read by the server. Fixed memory: 60 s of ticks, 10 min of bins, 500 events.
class Picture {
 public:
  using Clock = std::chrono::steady_clock;
  static constexpr std::size_t kRows = 60'000, kBins = 12'000, kEvents = 500;
  static constexpr std::int64_t kRowsAtFirst = 10'000, kRowsPerFrame = 1'400, kBinsPerFrame = 1'900;
  static constexpr std::size_t kLargestStatusText = 64U << 10U;

  /// Takes one message of the rig; what cannot be read is counted and left out.
  void take(std::string_view channel, Bytes data, Clock::time_point now);

  /// Everything before is of another time: a new run of the firmware, or a jump in a recording.
  void start_again(const std::vector<TraceBin>& history = {});

  /// Says that what is shown is as wanted although nothing new came: a recording that stands is not stale.
  void hold(Clock::time_point now);

  /// What pages are told of a topic ("status", "knot", "view", "replay", "marks"), when it changes and at their start.
  void set(const std::string& topic, nlohmann::json what);
  void add_event(const nlohmann::json& event);

  /// Another recording whose traces go along with each frame; null: none. It must live until this is called again.
  void show_beside(const Picture* other);

  /// The newest shape, or nothing when it is the one with number `known`, which is set.
  [[nodiscard]] std::optional<ligature_msg::thread_t> newer_shape(std::int64_t& known) const;

  /// One frame for a page that has been told up to `place`: the newest shape, the ticks since, what changed.
  /// Bounded: what does not fit comes next time; ticks that are gone by then are in the bins.
  [[nodiscard]] std::vector<std::byte> frame_for(Place& place, const nlohmann::json& answers,
                                                 Clock::time_point now) const;

  [[nodiscard]] std::int64_t unreadable() const;

 private:
  /// Never the same twice, of whatever picture.
  static std::int64_t next_epoch();
  void count_unreadable();
  void take_batch(const ligature_msg::tick_batch_t& batch);
  void start_again_locked();
  void set_locked(const std::string& topic, nlohmann::json what);
  void write_now(FrameWriter& frame, Clock::time_point now) const;
  void write_shape(FrameWriter& frame) const;
  void write_beside(FrameWriter& frame, TracePlace& place) const;
  /// @return whether the page starts again.
  bool begin_traces(TracePlace& place) const;
  void write_traces(FrameWriter& frame, TracePlace& place, Section rows, Section bins) const;
  [[nodiscard]] nlohmann::json changes_since(Place& place) const;

  mutable std::mutex mutex_;
  const Picture* beside_ = nullptr;
  std::int64_t epoch_ = next_epoch(), session_ = -1, unreadable_ = 0;
  std::optional<Clock::time_point> heard_;  // last ticks
  std::optional<ligature_msg::tick_t> last_;
  ligature_msg::thread_t thread_{};
  std::int64_t shape_version_ = 0;
  struct Topic {
    std::int64_t version = 0;
    nlohmann::json what;
  };
  std::map<std::string, Topic> topics_;
  Ring<TraceRow> rows_{kRows};
  Ring<TraceBin> bins_{kBins};
  Ring<nlohmann::json> events_{kEvents};
  BinMaker bin_maker_;
};

}  // namespace ligature::host::view
