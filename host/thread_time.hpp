#pragma once
#include <algorithm>
#include <cstdint>
#include <vector>

#include "host/percentile.hpp"
#include "ligature_msg/tick_t.hpp"

namespace ligature::host {

/// What each period left to the thread's physics, ns: from when the loop handed it the tools until it must stand still
/// for the next joints, less what the loop took for its SYNC meanwhile. Only pairs of executed periods that follow each
/// other and were in time tell it. 4 bytes a tick.
class ThreadTime {
 public:
  /// As firmware/rt/bus_time.hpp has it: so long before the next joints, which the bus delivers after so long at most.
  static constexpr std::int64_t kMargin_ns = 25'000, kJointsLatest_ns = 460'000;

  void add(const ligature_msg::tick_t& tick) {
    using ligature_msg::tick_t;
    const bool told = !(tick.flags & tick_t::FLAG_PERIOD_LOST), in_time = !(tick.flags & tick_t::FLAG_DEADLINE_MISSED);
    const std::int64_t woke_ns = tick.scheduled_ns + tick.wakeup_latency_ns;
    if (told && handed_at_ns_ >= 0 && tick.tick == last_ + 1) {
      const auto joints_ns = std::min<std::int64_t>(tick.tpdo_ns, kJointsLatest_ns);
      left_ns_.push_back(static_cast<std::int32_t>(woke_ns + joints_ns - kMargin_ns - tick.sync_ns - handed_at_ns_));
    }
    last_ = tick.tick;
    handed_at_ns_ = told && in_time ? woke_ns + tick.execution_ns : -1;
  }
  /// Ticks of another session follow.
  void start_session() { handed_at_ns_ = -1; }

  [[nodiscard]] bool known() const { return !left_ns_.empty(); }
  /// At least so much was left in this share of the periods. @param percent 0 < percent <= 100.
  [[nodiscard]] std::int32_t at_least_ns(double percent) const {
    auto negated = left_ns_;
    for (auto& left : negated) left = -left;
    return -percentile(negated, percent);
  }

 private:
  std::vector<std::int32_t> left_ns_;
  std::int64_t last_ = -1, handed_at_ns_ = -1;
};

}  // namespace ligature::host
