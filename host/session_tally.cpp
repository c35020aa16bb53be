#include "host/session_tally.hpp"

namespace ligature::host {

int SessionTally::find_or_add(std::int64_t id) {
  for (std::size_t i = sessions_.size(); i-- > 0;)  // from the newest: it is nearly always that one
    if (sessions_[i].id == id) return static_cast<int>(i);
  if (sessions_.size() >= kMaxSessions) return -1;
  sessions_.push_back({.id = id, .ring_dropped = 0, .ticks = {}});
  return static_cast<int>(sessions_.size()) - 1;
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
