#pragma once
// A bus and a clock that cost nothing, so that what a watched cycle does is the cycle's own doing.

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

/// The real bus would allocate nowhere; this one must not either, so the samples it notes are dropped.
class QuietBus {
 public:
  QuietBus(VirtualBus& bus, QuietClock& clock) : bus_(bus), clock_(clock) {}
  void send_sync() noexcept { bus_.send_sync(); }
  rt::RigReading read_tpdos(Nanoseconds) noexcept {
    clock_.time += rt::kSamplesLatest;
    return bus_.reading;
  }
  rt::WireTorque write_rpdos(const rt::RigCommand& c) noexcept { return bus_.write_rpdos(c); }

 private:
  VirtualBus& bus_;
  QuietClock& clock_;
};

/// Both contexts of a rig on one thread: the physics runs where the loop wakes it.
struct QuietRun {
  explicit QuietRun(VirtualRig& r) : rig(r) { clock.thread = &physics; }
  VirtualRig& rig;
  QuietClock clock;
  QuietBus bus{rig.bus, clock};
  lab::VirtualThread physics{clock.time, rig.thread, *rig.exchange, rig.outlets->shape};
  Cycle<QuietBus, QuietClock, lab::VirtualThread> cycle{bus, clock, rig.controller, *rig.exchange, physics, *rig.outlets};
};

}  // namespace ligature
