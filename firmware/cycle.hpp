#pragma once
// THE loop. Linux stands behind Bus and Clock in the program, fakes in virtual time stand there in tests.

#include <algorithm>
#include <chrono>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>

#include "firmware/control/controller.hpp"
#include "firmware/control/plant.hpp"
#include "firmware/control/tick_report.hpp"
#include "firmware/physics/simulation.hpp"
#include "firmware/rt/cycle_timing.hpp"
#include "firmware/rt/outlets.hpp"
#include "firmware/rt/period.hpp"

namespace ligature {

using Nanoseconds = std::chrono::nanoseconds;  ///< time points are nanoseconds of one monotonic clock

// Version 14 of clang-format tears compound requirements apart.
// clang-format off
template <class C>
concept Clock = requires(C c, Nanoseconds at) {
  { c.now() } noexcept -> std::same_as<Nanoseconds>;
  { c.sleep_until(at) } noexcept;
  { c.worked() } noexcept -> std::same_as<Nanoseconds>;  // CPU time of this thread
};
template <class B>
concept Bus = requires(B b, Nanoseconds deadline, const rt::RigCommand& command) {
  { b.send_sync() } noexcept;                                           // every drive samples and acts now
  { b.read_tpdos(deadline) } noexcept -> std::same_as<rt::RigReading>;  // returns early when all have come
  { b.write_rpdos(command) } noexcept -> std::same_as<rt::WireTorque>;  // acts at the next SYNC
};
// clang-format on

/// One period after the other until the controller has shut the rig down. Period k is due at start + k T; whole periods
/// that pass unused are counted, recorded and skipped, never made up for. No allocation, lock, log or exception in
/// run().
template <Bus BusT, Clock ClockT>
class Cycle {
 public:
  static constexpr Nanoseconds kPeriod = rt::kPeriod;
  /// From SYNC; the bus needs at most 460 us for SYNC and TPDOs, and 285 for the RPDOs before the next SYNC.
  static constexpr Nanoseconds kTpdoWait = std::chrono::microseconds(680);
  /// What the bus leaves of a period, at its longest: a tick that computes for longer cannot be in time.
  static constexpr Nanoseconds kMostWork = kPeriod - std::chrono::microseconds(460);
  static constexpr std::int64_t kTicksPerShape = 8;

  Cycle(BusT& bus, ClockT& clock, control::Controller& controller, physics::Simulation& thread,
        rt::Outlets& out) noexcept
      : bus_(bus), clock_(clock), controller_(controller), thread_(thread), out_(out) {}

  void end_after(std::int64_t ticks) noexcept { last_tick_ = ticks; }
  /// Where other scenes and parameters come from.
  void listen(control::PlantHandover& plants) noexcept { plants_ = &plants; }
  [[nodiscard]] const rt::CycleTiming& timing() const noexcept { return timing_; }
  [[nodiscard]] std::int64_t periods() const noexcept { return tick_; }

  void run() noexcept {
    wake_at_ = clock_.now() + kPeriod;
    while (!controller_.is_finished()) {
      clock_.sleep_until(wake_at_);  // absolute: jitter does not accumulate
      const auto woke = clock_.now();
      skip((woke - wake_at_) / kPeriod);  // slept through

      take_commands();
      take_plant();
      bus_.send_sync();  // every axis samples, and acts on the last tick's torque
      const auto synced = clock_.now();
      const rt::RigReading reading = bus_.read_tpdos(woke + kTpdoWait);
      const auto sampled = clock_.now();
      const auto worked_before = clock_.worked();
      const rt::RigCommand command = controller_.tick(input(reading, sampled - woke >= kPeriod));
      const auto decided = clock_.now();
      const rt::WireTorque torque = bus_.write_rpdos(command);
      const auto controlled = clock_.now();
      thread_.tick(controller_.tools());  // the rest of the period is the thread's
      const auto done = clock_.now();

      publish({woke, synced, sampled, decided, controlled, done}, clock_.worked() - worked_before, torque);
      const auto missed = (done - wake_at_) / kPeriod;
      advance();
      skip(missed);
    }
  }

 private:
  /// When each phase of a tick ended.
  struct Phases {
    Nanoseconds woke, synced, sampled, decided, controlled, done;
  };

  void take_commands() noexcept {
    if (out_.stop.load(std::memory_order_relaxed) || tick_ >= last_tick_) controller_.shut_down();
    bool reset = false;
    rt::Command c;
    for (std::size_t left = out_.commands.capacity(); left > 0 && out_.commands.pop(c); --left) {
      controller_.command(c.kind);
      reset = reset || c.kind == rt::CommandKind::kResetThread;
    }
    if (reset) thread_.reset();  // 4 us for a rod: once, however many of a flood ask for it
  }

  /// Changes the thread by a swap of its insides: nothing is built or freed here. The old one goes back in the new
  /// one's place. Another scene is taken only where no force may flow; parameters at any time.
  void take_plant() noexcept {
    control::Plant* plant = plants_ != nullptr ? plants_->take() : nullptr;
    if (plant == nullptr) return;
    plant->taken = plant->keeps_motion ? plant->thread.continue_from(thread_)
                                       : !controller_.armed() && !control::may_push(controller_.state());
    if (plant->taken) {
      std::swap(thread_, plant->thread);
      if (plant->keeps_motion)
        controller_.change_force_scale(plant->hands.force_scale);
      else
        controller_.change_hands(plant->hands);
    }
    plants_->give_back(plant);
  }

  control::TickInput input(const rt::RigReading& reading, bool late) const noexcept {
    return {
        tick_,
        reading,
        {control::grasp_of(thread_.hand(physics::Hand::kLeft)), control::grasp_of(thread_.hand(physics::Hand::kRight))},
        thread_.diagnostics().finite,
        late};
  }

  void publish(const Phases& at, Nanoseconds work, const rt::WireTorque& torque) noexcept {
    timing_.wakeup.add((at.woke - wake_at_).count());
    timing_.control.add((at.controlled - at.woke).count());
    timing_.execution.add((at.done - at.woke).count());
    timing_.work.add(work.count());
    const bool missed = at.done >= wake_at_ + kPeriod, overworked = work > kMostWork;
    timing_.deadline_misses += missed;
    timing_.overworked += overworked;

    record_ = {};
    record_.tick = tick_;
    record_.scheduled_ns = wake_at_.count();
    record_.wakeup_latency_ns = narrow(at.woke - wake_at_);
    record_.sync_ns = narrow(at.synced - at.woke);
    record_.tpdo_ns = narrow(at.sampled - at.woke);
    record_.law_ns = narrow(at.decided - at.woke);
    record_.control_ns = narrow(at.controlled - at.woke);
    record_.execution_ns = narrow(at.done - at.woke);
    record_.flags = (missed ? rt::kDeadlineMissed : 0) | (overworked ? rt::kOverworked : 0);
    record_.torque_permille = torque;
    control::report(controller_, record_);
    control::report(thread_.diagnostics(), record_);
    control::report(thread_.hand(physics::Hand::kLeft), 0, record_);
    control::report(thread_.hand(physics::Hand::kRight), 1, record_);
    out_.tell(record_);
    if (tick_ % kTicksPerShape == 0) {
      rt::ThreadSnapshot& shape = out_.shape.back();
      control::report(thread_.nodes_W(), record_, shape);
      const auto count = static_cast<std::size_t>(shape.count);
      thread_.describe(std::span(shape.tension_N).first(count), std::span(shape.turn_rad).first(count));
      out_.shape.publish();
    }
  }

  void advance() noexcept {
    ++tick_;
    wake_at_ += kPeriod;
  }

  /// Lost periods: the last values again, flagged. What no ring can hold is counted as dropped in one go.
  void skip(std::int64_t periods) noexcept {
    const auto room = static_cast<std::int64_t>(out_.room());
    for (std::int64_t i = 0; i < periods; ++i, advance()) {
      if (i >= room) {
        out_.count_untold(static_cast<std::uint64_t>(periods - i));
        tick_ += periods - i;
        wake_at_ += (periods - i) * kPeriod;
        break;
      }
      record_.tick = tick_;
      record_.scheduled_ns = wake_at_.count();
      record_.flags |= rt::kPeriodLost;
      record_.flags &= ~(rt::kDeadlineMissed | rt::kOverworked);  // those were the executed one's
      out_.tell(record_);
    }
    timing_.periods_lost += static_cast<std::uint64_t>(periods);
  }

  static std::int32_t narrow(Nanoseconds t) noexcept {
    constexpr auto kMax = Nanoseconds(std::numeric_limits<std::int32_t>::max());
    return static_cast<std::int32_t>(std::min(t, kMax).count());
  }

  BusT& bus_;
  ClockT& clock_;
  control::Controller& controller_;
  physics::Simulation& thread_;
  rt::Outlets& out_;
  control::PlantHandover* plants_ = nullptr;
  rt::CycleTiming timing_;
  rt::TickRecord record_;
  Nanoseconds wake_at_{};
  std::int64_t tick_ = 0;
  std::int64_t last_tick_ = std::numeric_limits<std::int64_t>::max();
};

}  // namespace ligature
