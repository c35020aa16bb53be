#include "host/lab/rig/true_tip.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "protocol/can/device_profile.hpp"

namespace ligature::lab {

void TruthWatch::look(const sim::HandDevice& device) {
  const sim::Mechanics& arm = device.mechanics();
  const sim::Vec3& torque_Nm = arm.made_Nm();
  const sim::Vec3 q_rad = arm.plant().q_rad(), p_m = linkage_.tip_D_m(q_rad);
  const auto force_N = [&](const sim::Vec3& pose_rad, const sim::Vec3& made_Nm) -> sim::Vec3 {
    return linkage_.jacobian_D(pose_rad).transpose().inverse() * made_Nm;
  };
  TrueTip tip;
  tip.f_N = force_N(q_rad, torque_Nm);
  if (!tips_.empty()) tip.step_N = force_N(q_rad_, torque_Nm - torque_Nm_).norm();
  tip.in_workspace = (p_m.array() >= low_m_.array()).all() && (p_m.array() <= high_m_.array()).all();
  tip.dead_man = (arm.buttons() & can::profile::kButtonDeadMan) != 0;
  tip.guarded = arm.motors().is_holding();
  for (std::size_t j = 0; j < tip.permille.size(); ++j)
    tip.permille[j] = static_cast<std::int16_t>(
        std::lround(torque_Nm[static_cast<Eigen::Index>(j)] / arm.body().drives.torque_Nm(1)));
  tip.drives_on = std::ranges::all_of(device.drives(), [](const auto& drive) { return drive->is_enabled(); });
  tips_.push_back(tip);
  torque_Nm_ = torque_Nm;
  q_rad_ = q_rad;
}

}  // namespace ligature::lab
