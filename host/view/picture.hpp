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

/// How far a page has received a picture's traces.
struct TracePlace {
  std::int64_t epoch = -1;  // the picture's epoch that the page knows; when it changes, the page discards everything
  std::int64_t row = 0, bin = 0;
};

/// How far a page has received a picture.
struct Place {
  TracePlace traces, beside;
  std::int64_t event = 0, shape = -1;
  std::map<std::string, std::int64_t> topics;  // per topic: the version that the page has
  std::uint32_t frame = 0;
};

/// The newest state of the rig, from which all pages are drawn. Written by the LCM or playback thread and by the knot
/// thread; read by the server. Memory is fixed: 60 s of ticks, 10 min of trace bins (smallest and largest values of 50
/// ticks each), 500 events.
class Picture {
 public:
  using Clock = std::chrono::steady_clock;
  static constexpr std::size_t kRows = 60'000, kBins = 12'000, kEvents = 500;
  static constexpr std::int64_t kRowsAtFirst = 10'000, kRowsPerFrame = 1'250, kBinsPerFrame = 1'900;
  static constexpr std::size_t kLargestStatusText = 64U << 10U;

  /// Takes one message of the rig; unreadable ones are counted and ignored.
  void take(std::string_view channel, Bytes data, Clock::time_point now);

  /// Discards everything, at a new session of the firmware or a jump in a recording. @param history bins to start with.
  void start_again(const std::vector<TraceBin>& history = {});

  /// Marks the data as current although nothing new came: a paused recording is not outdated.
  void hold(Clock::time_point now);

  /// Sets the content of a topic ("status", "scene", "knot", "view", "replay", "marks", "compare", "hands",
  /// "recording"). Pages receive it when it changes and when they connect.
  void set(const std::string& topic, nlohmann::json what);
  void add_event(const nlohmann::json& event);

  /// Sets a second recording whose traces are sent with each frame; null: none. `other` must outlive its use here.
  void show_beside(const Picture* other);

  /// The newest shape; nothing when its number is still `known`, which is updated.
  [[nodiscard]] std::optional<ligature_msg::thread_t> newer_shape(std::int64_t& known) const;

  /// Builds one frame for a page at `place`: the newest shape, the ticks since the page's last frame, and the topics
  /// that have changed. The size is bounded: ticks that do not fit follow in the next frame, and the trace bins cover
  /// ticks that are no longer kept by then.
  [[nodiscard]] std::vector<std::byte> frame_for(Place& place, const nlohmann::json& answers,
                                                 Clock::time_point now) const;

  [[nodiscard]] std::int64_t unreadable() const;

 private:
  /// A number that no other picture has had: it marks the data since the last start_again().
  static std::int64_t next_epoch();
  void count_unreadable();
  void take_batch(const ligature_msg::tick_batch_t& batch);
  void take_status(const ligature_msg::status_t& status);
  void start_again_locked();
  void set_locked(const std::string& topic, nlohmann::json what);
  void write_now(FrameWriter& frame, Clock::time_point now) const;
  void write_shape(FrameWriter& frame) const;
  void write_beside(FrameWriter& frame, TracePlace& place) const;
  /// @return whether the page must discard the traces that it has, because the picture's epoch has changed.
  bool begin_traces(TracePlace& place) const;
  void write_traces(FrameWriter& frame, TracePlace& place, Section rows, Section bins) const;
  [[nodiscard]] nlohmann::json changes_since(Place& place) const;

  mutable std::mutex mutex_;
  const Picture* beside_ = nullptr;
  std::int64_t epoch_ = next_epoch(), session_ = -1, unreadable_ = 0;
  std::optional<Clock::time_point> heard_;  // when the last ticks were received
  std::optional<ligature_msg::tick_t> last_;
  ligature_msg::thread_t thread_{};
  std::int64_t shape_version_ = 0;
  struct Topic {
    std::int64_t version = 0;
    nlohmann::json what;
  };
  std::map<std::string, Topic> topics_;
  std::string scene_;  // file and text of the scene whose facts are in topic "scene"
  Ring<TraceRow> rows_{kRows};
  Ring<TraceBin> bins_{kBins};
  Ring<nlohmann::json> events_{kEvents};
  BinMaker bin_maker_;
};

}  // namespace ligature::host::view
