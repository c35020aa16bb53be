#include "host/stream/live_topics.hpp"

namespace ligature::host::stream {

std::uint64_t LiveTopics::time_of(std::int64_t tick) const {
  return static_cast<std::uint64_t>(session_us_.value()) * 1000 + viewer_time_ns(facts_.time_s(tick));
}

void LiveTopics::take_status(const ligature_msg::status_t& status) {
  if (session_us_ != status.session) ++sessions_;
  session_us_ = status.session;
  facts_.period_s = status.period_s;
}

std::vector<TopicMessage> LiveTopics::take(const Message& message) {
  std::vector<TopicMessage> out;
  if (message.channel == kStatusChannel) {
    if (const auto status = decode<ligature_msg::status_t>(message.data)) take_status(*status);
  } else if (!session_us_) {
    return out;
  } else if (message.channel == kTicksChannel) {
    const auto batch = decode<ligature_msg::tick_batch_t>(message.data);
    if (!batch || batch->session != *session_us_) return out;
    for (const auto& tick : batch->ticks) {
      const auto& texts = tick_json_.write(tick, sessions_);
      for (std::uint32_t topic = 0; topic < texts.size(); ++topic)
        out.push_back({topic, time_of(tick.tick), texts[topic]});
    }
  } else if (message.channel == kThreadChannel) {
    if (const auto thread = decode<ligature_msg::thread_t>(message.data))
      out.push_back({kThreadTopic, time_of(thread->tick), shape_json(*thread, time_of(thread->tick))});
  } else if (message.channel == kEventChannel) {
    if (const auto event = decode<ligature_msg::event_t>(message.data))
      out.push_back({kEventsTopic, time_of(event->tick), event_json(*event)});
  }
  return out;
}

}  // namespace ligature::host::stream
