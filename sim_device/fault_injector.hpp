#pragma once
// Injects faults between a hand's drives and the bus, as a script describes.

#include <array>
#include <optional>
#include <random>
#include <vector>

#include "protocol/scene/fault_script.hpp"
#include "sim_device/hand_device.hpp"

namespace ligature::sim {

/// Changes the frames that a device sends; the device itself is not affected, except by kReboot, kEmergency and
/// kAstray, which it executes. Deterministic for a given script. Times count from the first SYNC.
class FaultInjector {
 public:
  explicit FaultInjector(const scene::FaultScript& script)
      : script_(script), random_(static_cast<std::mt19937::result_type>(script.seed)) {}

  /// Call after HandDevice::advance(): changes the frames added since the last call, and triggers the script's faults
  /// in the device. Keeps deliveries() ordered by time.
  void apply(HandDevice& device, Time now);

 private:
  void once(HandDevice& device, Time now);
  void send_foreign(HandDevice& device, Time now) const;
  void change(const Delivery& delivery, std::vector<Delivery>& out);
  [[nodiscard]] bool is_hit(const Delivery& delivery);
  [[nodiscard]] can::Frame with_wrong_reading(const can::Frame& frame, bool active);

  scene::FaultScript script_;
  std::mt19937 random_;
  Time onset_ = kNever, end_ = kNever;
  bool done_once_ = false;
  Time next_foreign_ = kNever;
  std::array<std::int32_t, 3> before_counts_{};  // true readings of each node when the fault began
  std::uint16_t before_buttons_ = 0;
  std::optional<Delivery> held_;  // frame held back until the next one (kReorder)
};

}  // namespace ligature::sim
