#pragma once
#include <string>

#include "firmware/app/doctor/report.hpp"

namespace ligature::app {

/// Sends an empty frame on an interface every 2 ms, and measures the time until the frame is read back. This time
/// contains the system calls, the driver, and the frame's time on the wire (47 us at 1 Mbit/s). The frames have the
/// identifier 0x7FF: no CANopen service uses it, and its priority is the lowest, so they delay hardly any other frame.
[[nodiscard]] CanEcho measure_echo(const std::string& interface, double seconds);

}  // namespace ligature::app
