#pragma once
#include <algorithm>
#include <cstdint>
#include <vector>

#include "host/percentile.hpp"
#include "ligature_msg/tick_t.hpp"

namespace ligature::host {

/// The time that each period left for the thread's physics, ns: from when the loop hands over the tool samples until
/// the physics must pause for the next joint samples, less the time in which the loop sent the next SYNC. Computed only
/// from pairs of consecutive executed periods without a deadline miss. 4 bytes a tick.
class ThreadTime {
 public:
  /// kMargin_ns: the physics must end this long before the joint samples arrive, as in firmware/rt/bus_time.hpp.
  /// kForgets_ns: the arrival is predicted from the earliest recent one. Each period moves the prediction later by this
  /// much, until samples arrive earlier than predicted.
  static constexpr std::int64_t kMargin_ns = 25'000, kForgets_ns = 20;

  void add(const ligature_msg::tick_t& tick) {
    using ligature_msg::tick_t;
    const bool told = !(tick.flags & tick_t::FLAG_PERIOD_LOST), in_time = !(tick.flags & tick_t::FLAG_DEADLINE_MISSED);
    const std::int64_t woke_ns = tick.scheduled_ns + tick.wakeup_latency_ns;
    if (told) predict(tick.tpdo_ns);
    if (told && handed_at_ns_ >= 0 && tick.tick == last_ + 1)
      left_ns_.push_back(static_cast<std::int32_t>(woke_ns + joints_ns_ - kMargin_ns - tick.sync_ns - handed_at_ns_));
    last_ = tick.tick;
    handed_at_ns_ = told && in_time ? woke_ns + tick.execution_ns : -1;
  }
  /// Call before the ticks of another session.
  /// @param samples_earliest_ns earliest time after the wake-up at which the bus can have carried the joint samples;
  ///        samples that came before it predict nothing. 0: not known.
  void start_session(std::int64_t samples_earliest_ns = 0) {
    handed_at_ns_ = -1, joints_ns_ = kLate_ns, samples_earliest_ns_ = samples_earliest_ns;
  }

  [[nodiscard]] bool known() const { return !left_ns_.empty(); }
  /// The time that was available in at least `percent` % of the periods. @param percent 0 < percent <= 100.
  [[nodiscard]] std::int32_t at_least_ns(double percent) const {
    auto negated = left_ns_;
    for (auto& left : negated) left = -left;
    return -percentile(negated, percent);
  }

 private:
  void predict(std::int64_t came_ns) {
    joints_ns_ += kForgets_ns;
    if (came_ns >= samples_earliest_ns_) joints_ns_ = std::min(joints_ns_, came_ns);
  }

  std::vector<std::int32_t> left_ns_;
  static constexpr std::int64_t kLate_ns = 1'000'000;  // nothing observed yet
  std::int64_t last_ = -1, handed_at_ns_ = -1, joints_ns_ = kLate_ns, samples_earliest_ns_ = 0;
};

}  // namespace ligature::host
