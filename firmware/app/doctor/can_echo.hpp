#pragma once
#include <string>

#include "firmware/app/doctor/report.hpp"

namespace ligature::app {

/// Sends an empty frame on an interface every 2 ms, and measures the time until the frame is read back. This time
/// contains the system calls, the driver, and the frame's time on the wire (47 us at 1 Mbit/s). The frames have the
/// identifier 0x7C1, whose low priority delays hardly any other frame. No drive acts on it: no CANopen service uses it,
/// ODrives take it for the heartbeat of a node 62, and moteus drives for a frame to a node 65. (0x7FF would tell every
/// ODrive to enter its boot loader.)
[[nodiscard]] CanEcho measure_echo(const std::string& interface, double seconds);

/// CPU time of sending and reading one such frame on a local socket, us: the median of 500.
[[nodiscard]] double local_exchange_us();

}  // namespace ligature::app
