#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "host/lcm_link.hpp"
#include "host/rig_facts.hpp"
#include "host/stream/foxglove_server.hpp"
#include "host/viewer_topics.hpp"

namespace ligature::host::stream {

/// Turns messages of the rig into messages of the viewers' topics. Their time is the wall clock at the firmware's start
/// plus the time of the tick, so that ticks are evenly spaced although they arrive in batches.
/// Nothing comes out before the first status message (ten a second), which tells the length of a period.
class LiveTopics {
 public:
  /// @return the messages to send; none for a message that is of another kind or cannot be read.
  [[nodiscard]] std::vector<TopicMessage> take(const Message& message);

 private:
  [[nodiscard]] std::uint64_t time_of(std::int64_t tick) const;
  void take_status(const ligature_msg::status_t& status);

  TickJson tick_json_;
  RigFacts facts_;
  std::optional<std::int64_t> session_us_;  // the firmware's start
  int sessions_ = 0;
};

}  // namespace ligature::host::stream
