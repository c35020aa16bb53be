#pragma once
// Ticks, shapes and events as the JSON messages that Foxglove and PlotJuggler read: in an MCAP file, and live.

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "host/tick_columns.hpp"
#include "ligature_msg/event_t.hpp"
#include "ligature_msg/thread_t.hpp"

namespace ligature::host {

struct ViewerTopic {
  std::string name;         ///< such as "/left"
  std::string schema_name;  ///< such as "ligature.left"
  std::string schema;       ///< JSON schema of its messages; describes each field with its unit
};

/// Indices into viewer_topics(). A tick is one message on each of the first three.
enum : std::size_t { kRigTopic, kLeftTopic, kRightTopic, kThreadTopic, kEventsTopic, kViewerTopics };

[[nodiscard]] const std::array<ViewerTopic, kViewerTopics>& viewer_topics();

/// Writes ticks as JSON. Numbers read back to the same bits; what is not finite becomes null, as JSON has no word for
/// it. The text of a number is kept and used again while the number stays the same: most fields seldom change.
class TickJson {
 public:
  TickJson();
  /// @return the messages of the topics kRigTopic, kLeftTopic and kRightTopic; valid until the next call.
  [[nodiscard]] const std::array<std::string, 3>& write(const ligature_msg::tick_t& tick, int session);

 private:
  struct Field {
    const TickColumn* column;  // null: the session
    std::string text;          // key, colon and value
    std::size_t key_bytes;
    std::uint64_t bits;
    bool is_written = false;
  };
  void update(Field& field, const ligature_msg::tick_t& tick, int session) const;

  std::array<std::vector<Field>, 3> fields_;
  std::array<std::string, 3> messages_;
};

/// A shape as foxglove.SceneUpdate: viewers draw the thread as a line of its true thickness.
[[nodiscard]] std::string shape_json(const ligature_msg::thread_t& thread, std::uint64_t time_ns);
[[nodiscard]] std::string event_json(const ligature_msg::event_t& event);

/// Time in whole nanoseconds, as viewers count it; 0 before the start.
[[nodiscard]] std::uint64_t viewer_time_ns(double t_s);

}  // namespace ligature::host
