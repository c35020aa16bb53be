#pragma once
// Both hands' buses as the loop sees them.

#include "firmware/platform/bus_wait.hpp"
#include "firmware/platform/hand_link.hpp"

namespace ligature::platform {

class RigBus {
 public:
  RigBus(CanBus& left, CanBus& right, BusWait& wait, const device::Device& device = device::omni())
      : hands_{HandLink(left, device), HandLink(right, device, HandLink::kHeartbeatPeriods / 2)}, wait_(wait) {}

  void send_sync() noexcept;
  /// Returns as soon as both hands have answered, at the latest at the deadline.
  [[nodiscard]] rt::RigReading read_tpdos(Nanoseconds deadline) noexcept;
  rt::WireTorque write_rpdos(const rt::RigCommand& command) noexcept;

 private:
  // Their heartbeats fall into different periods: no period has the work of both.
  std::array<HandLink, rt::kHands> hands_;
  BusWait& wait_;
};

}  // namespace ligature::platform
