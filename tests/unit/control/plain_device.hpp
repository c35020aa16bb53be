#pragma once
#include "protocol/device/device.hpp"

namespace ligature::control {

inline constexpr double kT_s = 1e-3;

/// Three drums of 1 m radius, so that torque equals force and angle equals position.
inline device::Device plain() {
  device::Device d = device::omni();
  d.kinematics = device::Kinematics::kCartesian;
  d.links_m = {1, 1, 1};
  d.home_tip_m = {0, 0, 0};
  return d;
}

}  // namespace ligature::control
