#pragma once
// Both hands' buses as one, for the loop.

#include "firmware/platform/bus_wait.hpp"
#include "firmware/platform/hand_link.hpp"

namespace ligature::platform {

class RigBus {
 public:
  RigBus(CanBus& left, CanBus& right, BusWait& wait, const device::Device& device = device::omni())
      : hands_{HandLink(left, device), HandLink(right, device, HandLink::kHeartbeatPeriods / 2)}, wait_(wait) {}

  void send_sync() noexcept;
  /// Returns as soon as both hands have answered, and at the deadline at the latest.
  [[nodiscard]] rt::RigReading read_tpdos(Nanoseconds deadline) noexcept;
  rt::WireTorque write_rpdos(const rt::RigCommand& command) noexcept;

 private:
  // The two heartbeats are sent in different periods, to spread the work.
  std::array<HandLink, rt::kHands> hands_;
  BusWait& wait_;
};

}  // namespace ligature::platform
