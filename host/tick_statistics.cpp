#include "host/tick_statistics.hpp"

#include <cmath>

#include "host/percentile.hpp"

namespace ligature::host {

double magnitude(const double (&f)[3]) { return std::hypot(f[0], f[1], f[2]); }

void TickStatistics::add(const ligature_msg::tick_t& tick) {
  if (tick.flags & ligature_msg::tick_t::FLAG_PERIOD_LOST) {
    ++periods_lost_;
  } else {
    wakeup_ns_.push_back(tick.wakeup_latency_ns);
    control_ns_.push_back(tick.control_ns);
    execution_ns_.push_back(tick.execution_ns);
    if (tick.flags & ligature_msg::tick_t::FLAG_DEADLINE_MISSED) ++deadline_misses_;
    add_thread(tick);
  }
  thread_time_.add(tick);
  for (std::size_t hand = 0; hand < hands_.size(); ++hand) add_hand(hand, tick);
  if (tick.fault != last_fault_ && tick.fault != 0) faults_.push_back({tick.tick, tick.fault});
  last_fault_ = tick.fault;
}

void TickStatistics::add_thread(const ligature_msg::tick_t& tick) {
  if (tick.flags & ligature_msg::tick_t::FLAG_THREAD_LATE) {
    ++thread_.late;  // the thread's fields repeat those of an older tick
    return;
  }
  if (tick.thread_end == ligature_msg::tick_t::THREAD_WORK) ++thread_.by_work;
  if (tick.thread_end == ligature_msg::tick_t::THREAD_CLOCK) ++thread_.by_clock;
  thread_.lost_ticks += static_cast<double>(tick.time_lost);
}

/// Adds a tick to the force statistics. Lost periods count too, because the device kept the last force.
void TickStatistics::add_hand(std::size_t hand, const ligature_msg::tick_t& tick) {
  auto& felt = hands_[hand];
  const double force_N = magnitude(tick.f_device_N[hand]);
  if (force_N > felt.peak_N) {
    felt.peak_N = force_N;
    felt.peak_tick = tick.tick;
  }
  if (tick.grasped_node[hand] >= 0) {
    felt.sum_N += force_N;
    ++felt.grasp_ticks;
  }
  constexpr std::array<std::int32_t, 2> kLimited{ligature_msg::tick_t::FLAG_LEFT_LIMITED,
                                                 ligature_msg::tick_t::FLAG_RIGHT_LIMITED};
  if (tick.flags & kLimited[hand]) ++felt.limited_ticks;
}

Percentiles TickStatistics::percentiles_of(std::vector<std::int32_t> samples) {
  return {percentile(samples, 50.0), percentile(samples, 99.0), percentile(samples, 100.0)};
}

}  // namespace ligature::host
