#pragma once
// What the drivers of the CAN interfaces add to a tick. Admission otherwise measures calls on a local socket.

#include <string>
#include <variant>
#include <vector>

#include "protocol/device/device.hpp"

namespace ligature::app {

struct DriverTime {
  double calls_us = 0.0;                ///< CPU time of a tick's calls for both hands, beyond that on a local socket
  double delay_us = 0.0;                ///< longest way of a frame there and back (99.9 %), beyond its time on the wire
  std::vector<std::string> interfaces;  ///< on which it was measured; empty: not known

  /// A request and its samples are delayed by one way there and back, and so are the torques at most.
  [[nodiscard]] double delays_us() const noexcept { return 2.0 * delay_us; }
};

/// Sends empty frames on each interface for a second and reads them back (doctor/can_echo.hpp). With one interface, the
/// other hand's counts the same.
/// @return one line if an interface cannot be measured
[[nodiscard]] std::variant<DriverTime, std::string> measure_drivers(const std::vector<std::string>& interfaces,
                                                                    const device::Device& device);

}  // namespace ligature::app
