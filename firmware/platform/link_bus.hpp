#pragma once
// The bus of one hand as its link uses it: frames in and out, the time that they take, and whether the bus was lost.

#include "firmware/platform/bus_load.hpp"
#include "firmware/platform/can_bus.hpp"
#include "firmware/rt/rig_io.hpp"

namespace ligature::platform {

/// Real time: calls are bounded and make only the bus's system calls.
class LinkBus {
 public:
  explicit LinkBus(CanBus& bus) noexcept : bus_(bus) {}

  void begin_period() noexcept { load_.begin_period(); }

  /// Calls take(frame) for each frame that has arrived.
  template <class Take>
  void drain(Take take) noexcept {
    can::Frame frame;
    for (int i = 0; i < kMaxFrames && bus_.receive(frame) == Receive::kFrame; ++i) {
      load_.add(frame);
      take(frame);
    }
    note_loss();
  }

  /// @return whether the bus has taken the frame
  bool send(const can::Frame& frame) noexcept {
    if (!bus_.send(frame)) {
      note_loss();
      return false;
    }
    load_.add(frame);
    return true;
  }

  /// From now on until forget_loss() the bus is told as lost. A bus may recover before it is read.
  void lose() noexcept { was_lost_ = true; }
  void forget_loss() noexcept { was_lost_ = false; }
  [[nodiscard]] bool is_lost() const noexcept { return bus_.is_lost(); }

  void tell(rt::HandReading& r) const noexcept {
    r.bus_lost = was_lost_ || bus_.is_lost();
    r.bus_load = load_.of_last_period();
  }

 private:
  static constexpr int kMaxFrames = 64;  // read per call; a period on a 1 Mbit/s bus has fewer than 22

  void note_loss() noexcept { was_lost_ = was_lost_ || bus_.is_lost(); }

  CanBus& bus_;
  BusLoad load_;
  bool was_lost_ = false;
};

}  // namespace ligature::platform
