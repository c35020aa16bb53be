#pragma once
// What a device's motors truly do at its tip, whatever the wire, the encoders and the firmware say.

#include <array>
#include <cstdint>
#include <vector>

#include "protocol/device/device.hpp"
#include "sim_device/hand_device.hpp"

namespace ligature::lab {

/// In the period that ended just before a SYNC.
struct TrueTip {
  sim::Vec3 f_N = sim::Vec3::Zero();       ///< of the torques made, in the pose at the period's end
  double step_N = 0.0;                     ///< of the change of these torques, in the pose in which they changed
  bool in_workspace = true;                ///< the tip is within the device's workspace box
  bool guarded = false;                    ///< a drive makes less than it was asked for, to spare its winding
  bool dead_man = false;                   ///< the button is truly pressed
  bool drives_on = false;                  ///< all three, at the period's end
  std::array<std::int16_t, 3> permille{};  ///< the torques made, of the rated ones
};

/// Looks at one device once a period. The linkage is the simulation's own, not the controller's.
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
