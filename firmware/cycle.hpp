#pragma once
// The 1 kHz control loop. In the program, Bus and Clock use Linux's sockets and clock; in tests, they are fakes with
// simulated time.

#include <algorithm>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>

#include "firmware/clock.hpp"
#include "firmware/control/controller.hpp"
#include "firmware/control/period_log.hpp"
#include "firmware/control/plant.hpp"
#include "firmware/control/thread_link.hpp"
#include "firmware/control/tick_report.hpp"
#include "firmware/rt/bus_time.hpp"
#include "firmware/rt/outlets.hpp"
#include "firmware/rt/period.hpp"

namespace ligature {

// clang-format 14 splits compound requirements over several lines.
// clang-format off
template <class B>
concept Bus = requires(B b, Nanoseconds deadline, const rt::RigCommand& command) {
  // Drives sample their encoders and apply the torque that they got last
  { b.request() } noexcept;
  { b.read(deadline) } noexcept -> std::same_as<rt::RigReading>;  // returns as soon as all samples have come
  { b.write(command) } noexcept -> std::same_as<rt::WireTorque>;  // takes effect at the next request
  { b.bus_time() } noexcept -> std::same_as<rt::BusTime>;
};
template <class W>
concept Waker = requires(W w) {
  { w.wake() } noexcept;  // wakes the physics thread if it waits; it runs once this higher-priority thread sleeps
};
// clang-format on

/// Runs period after period until the controller has shut the rig down. Period k is due at start + k T. If the loop
/// wakes too late, the lost periods are counted, recorded and skipped, never made up for. The suture's physics
/// (thread_context.hpp) gets the tools of period k and normally finishes before the samples of period k + 1 arrive. If
/// the physics is late, the control law continues with the last grasp. run() does not allocate, lock, log or throw; it
/// waits only for the bus and the clock.
template <Bus BusT, Clock ClockT, Waker WakerT>
class Cycle {
 public:
  static constexpr Nanoseconds kPeriod = rt::kPeriod;

  Cycle(BusT& bus, ClockT& clock, control::Controller& controller, control::ThreadExchange& exchange, WakerT& physics,
        rt::Outlets& out) noexcept
      : bus_(bus),
        clock_(clock),
        controller_(controller),
        thread_(exchange),
        physics_(physics),
        out_(out),
        log_(out, bus.bus_time().most_work()),
        thread_deadline_(bus.bus_time()),
        longest_wait_(bus.bus_time().longest_wait()) {}

  void end_after(std::int64_t ticks) noexcept { last_tick_ = ticks; }
  /// Sets the channel through which new scenes and parameters reach the loop.
  void listen(control::PlantHandover& plants) noexcept { plants_ = &plants; }
  [[nodiscard]] const rt::CycleTiming& timing() const noexcept { return log_.timing(); }
  [[nodiscard]] std::int64_t periods() const noexcept { return tick_; }

  void run() noexcept {
    wake_at_ = clock_.now() + kPeriod;
    while (!controller_.is_finished()) {
      clock_.sleep_until(wake_at_);  // absolute: jitter does not accumulate
      control::Phases at{};
      at.woke = clock_.now();
      skip((at.woke - wake_at_) / kPeriod);  // periods lost by waking too late
      at.scheduled = wake_at_;

      take_commands();
      take_plant();
      bus_.request();  // all drives sample and apply the previous tick's torque
      at.synced = clock_.now();
      const rt::RigReading reading = bus_.read(at.woke + longest_wait_);
      at.sampled = clock_.now();
      const auto worked_before = clock_.worked();
      take_grasp();  // computed from the tools of the previous period
      const auto in = input(reading, at.sampled - at.woke >= kPeriod);
      const rt::RigCommand command = controller_.tick(in);
      at.decided = clock_.now();
      const rt::WireTorque torque = bus_.write(command);
      at.controlled = clock_.now();
      thread_deadline_.note(at.sampled - at.woke);
      const auto periods = (at.controlled - wake_at_) / kPeriod + 1;  // a late tick also delays the next one
      thread_.hand_over(tick_, controller_.tools(), thread_deadline_.before(wake_at_ + periods * kPeriod));
      physics_.wake();  // the physics may use the core until the next samples
      at.done = clock_.now();
      // Record of the previous period: its physics result is known only now
      log_.finish(thread_.result(), in.thread_late_ticks);
      log_.begin(tick_, at, clock_.worked() - worked_before, torque, controller_, thread_.orders(), in.grasp_age_ticks);
      const auto missed = (at.done - wake_at_) / kPeriod;
      advance(1);
      skip(missed);
    }
    log_.finish_last(thread_.result());
  }

 private:
  void take_commands() noexcept {
    if (out_.stop.load(std::memory_order_relaxed) || tick_ >= last_tick_) controller_.shut_down();
    rt::Command c;
    bool reset = false;
    for (std::size_t left = out_.commands.capacity(); left > 0 && out_.commands.pop(c); --left) {
      reset = reset || c.kind == rt::CommandKind::kResetThread;
      const bool arms = c.kind == rt::CommandKind::kArm;
      if (arms || c.kind == rt::CommandKind::kDisarm || c.kind == rt::CommandKind::kStop)
        arm_waits_ = arms && thread_.changes_scene();
      if (!arm_waits_ || !arms) controller_.command(c.kind);
    }
    if (reset) thread_.reset();  // one reset, however many were requested in this tick
  }

  /// Takes an offered plant (plant.hpp): a new scene only while no force may flow, new parameters at any time.
  void take_plant() noexcept {
    if (plants_ == nullptr || thread_.is_changing()) return;
    control::Plant* plant = plants_->take();
    if (plant == nullptr) return;
    plant->taken = plant->keeps_motion || (!controller_.armed() && !control::may_push(controller_.state()));
    plant->first_tick = tick_;
    if (plant->taken) return thread_.change(plant);
    plants_->give_back(plant);
  }

  /// Takes the newest result of the physics. If it is the first of a new scene, the controller changes to that scene's
  /// hand settings.
  void take_grasp() noexcept {
    control::Plant* const plant = thread_.collect();
    if (plant == nullptr) return;
    if (plant->taken && plant->keeps_motion) controller_.change_force_scale(plant->hands.force_scale);
    if (plant->taken && !plant->keeps_motion) controller_.change_hands(plant->hands);
    plants_->give_back(plant);
    if (std::exchange(arm_waits_, false)) controller_.command(rt::CommandKind::kArm);
  }

  control::TickInput input(const rt::RigReading& reading, bool late) const noexcept {
    const control::ThreadResult& thread = thread_.result();
    return {tick_,
            reading,
            {control::grasp_of(thread.hand[0]), control::grasp_of(thread.hand[1])},
            thread.health.finite,
            late,
            tick_ - thread.tick,
            thread_.late_ticks()};
  }

  void advance(std::int64_t periods) noexcept {
    tick_ += periods;
    wake_at_ += periods * kPeriod;
  }
  void skip(std::int64_t periods) noexcept {
    if (periods <= 0) return;
    log_.lose(tick_, wake_at_, periods);
    advance(periods);
  }

  BusT& bus_;
  ClockT& clock_;
  control::Controller& controller_;
  control::ThreadLink thread_;
  WakerT& physics_;
  rt::Outlets& out_;
  control::PeriodLog log_;
  rt::ThreadDeadline thread_deadline_;
  Nanoseconds longest_wait_;  // for samples, counted from the wake-up
  control::PlantHandover* plants_ = nullptr;
  bool arm_waits_ = false;  // ARM was requested while a new scene is being installed; it is executed after that
  Nanoseconds wake_at_{};
  std::int64_t tick_ = 0;
  std::int64_t last_tick_ = std::numeric_limits<std::int64_t>::max();
};

}  // namespace ligature
