#pragma once
// The physics thread, which runs beside the control loop (cycle.hpp) while the loop sleeps or waits for the bus.

#include <algorithm>
#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

#include "firmware/clock.hpp"
#include "firmware/control/thread_link.hpp"
#include "firmware/control/tick_report.hpp"
#include "firmware/physics/simulation.hpp"
#include "firmware/rt/tick_record.hpp"

namespace ligature {

/// Serves one request after the other: take(), compute(), publish(). Owns the simulation while it runs; others access
/// it only by requests. No allocation, lock, log or exception. Each request carries a deadline; when it passes, the
/// simulated thread does not move for the rest of that tick.
template <Clock ClockT>
class ThreadContext {
 public:
  ThreadContext(ClockT& clock, physics::Simulation& thread, control::ThreadExchange& exchange,
                rt::LatestValue<rt::ThreadSnapshot>& shape) noexcept
      : clock_(clock), thread_(thread), exchange_(exchange), shape_(shape) {}

  /// Runs until wake.wait() returns false.
  template <class WakeT>
  void run(WakeT& wake) noexcept {
    while (wake.wait()) {
      while (take()) {
        compute();
        publish();
      }
    }
  }

  /// Takes the newest request. @return false if there is none since the last call.
  bool take() noexcept { return exchange_.requests.refresh(); }

  void compute() noexcept {
    const control::ThreadRequest& asked = exchange_.requests.front();
    const auto worked_before = clock_.worked();
    result_.began = clock_.now();
    if (std::exchange(resets_, asked.resets) != asked.resets) thread_.reset();
    if (!take_plant(asked)) thread_.tick(asked.tools, {&ThreadContext::time_left, this});
    result_.tick = asked.tick;
    result_.number = asked.number;
    result_.hand = {thread_.hand(physics::Hand::kLeft), thread_.hand(physics::Hand::kRight)};
    result_.health = thread_.diagnostics();
    result_.add_step({asked.tick, result_.health.cut_at});
    result_.work = clock_.worked() - worked_before;
    result_.done = clock_.now();
  }

  /// The grasp is published first, because the control law uses it; the shape is for telemetry only.
  void publish() noexcept {
    exchange_.results.back() = result_;
    exchange_.results.publish();
    if (result_.tick / control::kTicksPerShape == shape_of_) return;
    shape_of_ = result_.tick / control::kTicksPerShape;
    control::report(thread_, result_, shape_.back());
    shape_.publish();
  }

 private:
  /// Swaps in a new simulation and gives back the old one, so that nothing is built or freed here. @return true if the
  /// new simulation has another scene: then this tick is not computed, because the tools belong to the old scene's
  /// hands.
  bool take_plant(const control::ThreadRequest& asked) noexcept {
    if (std::exchange(result_.plants, asked.plants) == asked.plants) return false;
    control::Plant& plant = *asked.plant;
    plant.taken = !plant.keeps_motion || plant.thread.continue_from(thread_);
    if (plant.taken) std::swap(thread_, plant.thread);
    return !plant.keeps_motion;
  }

  static std::int64_t time_left(void* self) noexcept {
    auto& me = *static_cast<ThreadContext*>(self);
    return (me.exchange_.requests.front().deadline - me.clock_.now()).count();
  }

  ClockT& clock_;
  physics::Simulation& thread_;
  control::ThreadExchange& exchange_;
  rt::LatestValue<rt::ThreadSnapshot>& shape_;
  control::ThreadResult result_;
  std::int64_t resets_ = 0, shape_of_ = -1;
};

}  // namespace ligature
