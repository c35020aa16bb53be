#pragma once
#include <string>

#include "firmware/app/doctor/report.hpp"

namespace ligature::app {

/// Sends empty frames on an interface, one each 2 ms, and times until each is read back: the calls, the driver, and the
/// frame's time on the wire (47 us at 1 Mbit/s). The identifier 0x7FF is that of no CANopen service, and the last in
/// the bus's order of priority, so that it delays nobody.
[[nodiscard]] CanEcho measure_echo(const std::string& interface, double seconds);

}  // namespace ligature::app
