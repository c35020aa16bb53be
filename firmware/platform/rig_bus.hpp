#pragma once
// The drives of both hands as one bus, for the loop.

#include "firmware/platform/bus_wait.hpp"
#include "firmware/platform/hand_drives.hpp"

namespace ligature::platform {

class RigBus {
 public:
  RigBus(HandDrives& left, HandDrives& right, BusWait& wait) noexcept : hands_{&left, &right}, wait_(wait) {}

  void request() noexcept;
  /// Returns as soon as both hands have answered, and at the deadline at the latest.
  [[nodiscard]] rt::RigReading read(Nanoseconds deadline) noexcept;
  rt::WireTorque write(const rt::RigCommand& command) noexcept;
  /// The slower hand's times.
  [[nodiscard]] rt::BusTime bus_time() const noexcept;

 private:
  std::array<HandDrives*, rt::kHands> hands_;
  BusWait& wait_;
};

}  // namespace ligature::platform
