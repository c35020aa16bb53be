#pragma once
#include <string>

#include "firmware/app/doctor/report.hpp"

namespace ligature::app {

/// Sends an empty frame on an interface every 2 ms, and measures the time until it is read back. This time contains the
/// system calls, the driver, and the frame's time on the wire (47 us at 1 Mbit/s). No CANopen service has the
/// identifier 0x7FF, and it has the lowest priority on the bus, so the frames delay nobody.
[[nodiscard]] CanEcho measure_echo(const std::string& interface, double seconds);

}  // namespace ligature::app
