#include "firmware/app/driver_time.hpp"

#include <algorithm>

#include "firmware/app/bus_calls.hpp"
#include "firmware/app/doctor/can_echo.hpp"
#include "firmware/rt/rig_io.hpp"

namespace ligature::app {

std::variant<DriverTime, std::string> measure_drivers(const std::vector<std::string>& interfaces,
                                                      const device::Device& device) {
  constexpr double kSeconds = 1.0, kOnTheWire_us = 47.0;  // an empty frame at 1 Mbit/s
  DriverTime time{.interfaces = interfaces};
  if (interfaces.empty()) return time;
  const int exchanges = exchanges_per_tick(device);
  const double local_us = local_exchange_us();
  for (const auto& interface : interfaces) {
    const CanEcho echo = measure_echo(interface, kSeconds);
    if (!echo.problem.empty()) return "--can " + interface + ": " + echo.problem;
    if (echo.lost > 0)
      return "--can " + interface + ": " + std::to_string(echo.lost) +
             " frames did not come back within 10 ms; remedy: ligature-firmware doctor --can " + interface;
    const double hands = static_cast<double>(rt::kHands) / static_cast<double>(interfaces.size());
    time.calls_us += hands * exchanges * std::max(0.0, echo.calls_us - local_us);
    time.delay_us = std::max(time.delay_us, echo.round_trips.quantile_us(0.999) - kOnTheWire_us);
  }
  return time;
}

}  // namespace ligature::app
