#include "sim_device/wire.hpp"

#include <algorithm>

namespace ligature::sim {

void Wire::submit(const can::Frame& frame, int sender, Time ready) {
  const auto index = static_cast<std::size_t>(sender);
  if (queues_.size() <= index) queues_.resize(index + 1);
  const Time bits{charge_time_ ? can::frame_ns(frame) : 0};
  queues_[index].push_back({frame, ready, bits});
}

Time Wire::earliest_ready() const noexcept {
  Time earliest = kNever;
  for (const auto& q : queues_) {
    if (!q.empty()) earliest = std::min(earliest, q.front().ready);
  }
  return earliest;
}

std::optional<Transmission> Wire::advance(Time now) {
  const Time earliest = earliest_ready();
  if (earliest == kNever) return std::nullopt;
  const Time start = std::max(free_at_, earliest);
  if (start > now) return std::nullopt;

  std::size_t winner = queues_.size();
  for (std::size_t i = 0; i < queues_.size(); ++i) {
    if (queues_[i].empty() || queues_[i].front().ready > start) continue;
    if (winner == queues_.size() ||
        can::rank_of(queues_[i].front().frame) < can::rank_of(queues_[winner].front().frame))
      winner = i;
  }
  const Pending sent = queues_[winner].front();
  queues_[winner].pop_front();
  free_at_ = start + sent.bits;
  ++stats_.frames;
  stats_.busy += sent.bits;
  stats_.worst_wait = std::max(stats_.worst_wait, start - sent.ready);
  const Time space{charge_time_ ? can::bits_to_ns(can::kInterframeBits) : 0};
  return Transmission{sent.frame, static_cast<int>(winner), start, free_at_ - space};
}

Time Wire::quiet_at() const noexcept {
  Time at = free_at_;
  bool any = false;
  for (const auto& q : queues_) {
    for (const Pending& p : q) {
      at = std::max(at, p.ready) + p.bits;
      any = true;
    }
  }
  return any ? at : kNever;
}

void Wire::drop(int sender) noexcept {
  const auto index = static_cast<std::size_t>(sender);
  if (index < queues_.size()) queues_[index].clear();
}

}  // namespace ligature::sim
