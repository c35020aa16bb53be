#pragma once
// Things that go wrong between a hand's drives and whoever listens to them, by script.

#include <array>
#include <optional>
#include <random>
#include <vector>

#include "protocol/scene/fault_script.hpp"
#include "sim_device/hand_device.hpp"

namespace ligature::sim {

/// Changes what the outside hears of a device; the device itself does not know (a reboot, an emergency and a drive
/// astray excepted: those it really does). Deterministic in its script. Times are since the first SYNC.
class FaultInjector {
 public:
  explicit FaultInjector(const scene::FaultScript& script)
      : script_(script), random_(static_cast<std::mt19937::result_type>(script.seed)) {}

  /// To be called after HandDevice::advance(): changes the frames that were added since the last call, and makes the
  /// device do what the script says. Keeps deliveries() in the order of their times.
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
  std::array<std::int32_t, 3> before_counts_{};  // of each node when the fault began
  std::uint16_t before_buttons_ = 0;
  std::optional<Delivery> held_;  // waits for the next one
};

}  // namespace ligature::sim
