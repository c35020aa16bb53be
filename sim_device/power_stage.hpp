#pragma once
// Injects the failure of a drive's power stage, for tests.

#include "sim_device/bus_node.hpp"

namespace ligature::sim {

/// The drive loses its torque and tells a fault as its protocol does: an ODrive by its next heartbeat, a moteus by its
/// next answer. @throw std::bad_cast for a CiA 402 drive, whose emergency a fault script sends.
void fail_power_stage(BusNode& drive);

}  // namespace ligature::sim
