#pragma once
// A haptic device as the bridge uses it: it reports a position in space and buttons, and it makes a force.

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <variant>

namespace ligature::bridge {

using Vec = std::array<double, 3>;  ///< in the device's base frame D: x right, y away from the person, z up

struct DeviceState {
  Vec p_D_m{};
  std::uint16_t buttons = 0;  ///< can::profile::kButton bits
};

/// One device behind its maker's interface. Used by one thread.
class Device {
 public:
  virtual ~Device() = default;
  /// Sends the force and reads the state. May wait for the device: some 10 ms for an answer, and up to 2 s to connect
  /// again. @return nothing when the device did not answer or is disconnected; the next call tries again.
  [[nodiscard]] virtual std::optional<DeviceState> exchange(const Vec& force_D_N) = 0;
  /// One line about why the last exchange returned nothing.
  [[nodiscard]] virtual std::string problem() const = 0;
};

using OpenedDevice = std::variant<std::unique_ptr<Device>, std::string>;  ///< or one line that says why not

}  // namespace ligature::bridge
