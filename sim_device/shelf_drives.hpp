#pragma once
// The drives of a simulated hand as its device record names them: CiA 402 drives, ODrives, or moteus controllers. With
// the latter two the elbow's drive stands for two nodes: the drive, and the module that sends the buttons
// (docs/drives.md).

#include "protocol/can/local_wire.hpp"
#include "protocol/device/device.hpp"
#include "sim_device/hand_device.hpp"

namespace ligature::sim {

[[nodiscard]] BusNodes drives_of(const device::Device& device, const DriveConstants& constants, Time now);

/// Whether the drives send and take CAN-FD frames.
[[nodiscard]] inline can::Network network_of(const device::Device& device) noexcept {
  return device.moteus ? can::Network::kFd : can::Network::kClassic;
}

}  // namespace ligature::sim
