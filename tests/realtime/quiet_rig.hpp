#pragma once
// A bus and a clock that make no system calls and allocate nothing, so that a watched cycle shows only its own calls
// and allocations.

#include "tests/unit/firmware/virtual_rig.hpp"

namespace ligature {

class QuietClock {
 public:
  Nanoseconds now() noexcept {
    if (thread != nullptr) thread->advance();
    return time;
  }
  void sleep_until(Nanoseconds at) noexcept { time = at; }
  Nanoseconds worked() noexcept { return Nanoseconds::zero(); }
  Nanoseconds time{0};
  lab::VirtualThread* thread = nullptr;
};

/// Drops the samples that VirtualBus records: storing them would allocate, which the real bus does not.
class QuietBus {
 public:
  QuietBus(VirtualBus& bus, QuietClock& clock) : bus_(bus), clock_(clock) {}
  void request() noexcept { bus_.request(); }
  rt::RigReading read(Nanoseconds) noexcept {
    clock_.time += bus_.bus_time().samples_latest;
    return bus_.reading;
  }
  rt::WireTorque write(const rt::RigCommand& c) noexcept { return bus_.write(c); }
  [[nodiscard]] rt::BusTime bus_time() const noexcept { return bus_.bus_time(); }

 private:
  VirtualBus& bus_;
  QuietClock& clock_;
};

/// Both real-time contexts on one thread of execution: the physics runs when the loop wakes it.
struct QuietRun {
  explicit QuietRun(VirtualRig& r) : rig(r) { clock.thread = &physics; }
  VirtualRig& rig;
  QuietClock clock;
  QuietBus bus{rig.bus, clock};
  lab::VirtualThread physics{clock.time, rig.thread, *rig.exchange, rig.outlets->shape};
  Cycle<QuietBus, QuietClock, lab::VirtualThread> cycle{bus,           clock,   rig.controller,
                                                        *rig.exchange, physics, *rig.outlets};
};

}  // namespace ligature
