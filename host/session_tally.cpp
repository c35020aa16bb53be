#include "host/session_tally.hpp"

#include <algorithm>

#include "ligature_msg/tick_t.hpp"

namespace ligature::host {

int SessionTally::find_or_add(std::int64_t id) {
  for (std::size_t i = sessions_.size();
       i-- > 0;)  // newest first, because nearly all ticks belong to the newest session
    if (sessions_[i].id == id) return static_cast<int>(i);
  if (sessions_.size() >= kMaxSessions) return -1;
  sessions_.push_back({.id = id, .ring_dropped = 0, .ticks = {}});
  return static_cast<int>(sessions_.size()) - 1;
}

bool SessionTally::add(int index, std::int64_t tick, std::int8_t state) {
  Session& session = sessions_[static_cast<std::size_t>(index)];
  // A late tick may fill a gap of an earlier session. But a tick that continues an earlier session beyond its last one
  // shows that two firmwares are sending.
  const bool is_last = static_cast<std::size_t>(index) + 1 == sessions_.size();
  if (!is_last && (session.ticks.is_empty() || tick > session.ticks.last())) interleaved_ = true;
  if (session.ticks.is_empty() || tick > session.ticks.last()) session.last_state = state;
  return session.ticks.add(tick);
}

const Session* SessionTally::open_ended() const {
  const auto found = std::ranges::find_if(sessions_, [](const Session& s) {
    return !s.ticks.is_empty() && s.last_state != ligature_msg::tick_t::STATE_OFF;
  });
  return found == sessions_.end() ? nullptr : &*found;
}

std::int64_t SessionTally::received() const {
  std::int64_t sum = 0;
  for (const auto& session : sessions_) sum += session.ticks.received();
  return sum;
}

std::int64_t SessionTally::missing() const {
  std::int64_t sum = 0;
  for (const auto& session : sessions_) sum += session.ticks.missing();
  return sum;
}

std::int64_t SessionTally::duplicates() const {
  std::int64_t sum = 0;
  for (const auto& session : sessions_) sum += session.ticks.duplicates();
  return sum;
}

}  // namespace ligature::host
