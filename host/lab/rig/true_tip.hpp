#pragma once
// The true motion and force at a device's tip, independent of bus, encoders and firmware.

#include <array>
#include <cstdint>
#include <vector>

#include "protocol/device/device.hpp"
#include "sim_device/hand_device.hpp"

namespace ligature::lab {

/// State during the period that ended just before a SYNC.
struct TrueTip {
  sim::Vec3 f_N = sim::Vec3::Zero();  ///< tip force of the motors' torques, in the pose at the period's end
  double step_N = 0.0;                ///< tip force of the change of these torques, in the pose in which they changed
  bool in_workspace = true;           ///< the tip is within the device's workspace box
  bool guarded = false;               ///< a drive makes less torque than commanded, to protect its winding
  bool dead_man = false;              ///< the dead-man button is really pressed
  bool drives_on = false;             ///< all three drives are on at the period's end
  std::array<std::int16_t, 3> permille{};  ///< the motors' torques in permille of the rated ones
};

/// Observes one device once a period. Uses the simulation's linkage, not the controller's.
class TruthWatch {
 public:
  explicit TruthWatch(const device::Device& device)
      : linkage_(device), low_m_(device.workspace_min_m.data()), high_m_(device.workspace_max_m.data()) {}

  void look(const sim::HandDevice& device);
  [[nodiscard]] const std::vector<TrueTip>& tips() const noexcept { return tips_; }

 private:
  sim::Linkage linkage_;
  sim::Vec3 low_m_, high_m_;
  sim::Vec3 torque_Nm_ = sim::Vec3::Zero(), q_rad_ = sim::Vec3::Zero();
  std::vector<TrueTip> tips_;
};

}  // namespace ligature::lab
