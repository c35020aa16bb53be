#pragma once
// The drives that a device record describes. A new protocol is added here (docs/drives.md).

#include <memory>
#include <string>
#include <vector>

#include "firmware/platform/hand_drives.hpp"
#include "protocol/can/local_wire.hpp"
#include "protocol/device/device.hpp"

namespace ligature::platform {

/// @param watchdog_ms requested time after which silent drives remove their torque
/// @param hand index, 0 left or 1 right
[[nodiscard]] std::unique_ptr<HandDrives> make_drives(CanBus& bus, const device::Device& device, int watchdog_ms,
                                                      std::size_t hand);

/// How long the messages of a period with these drives occupy the bus. Known from the record, before a bus is open.
[[nodiscard]] rt::BusTime bus_time_of(const device::Device& device) noexcept;

/// Which guarantees drives of this record cannot give, one line each, before a bus is open.
/// @param watchdog_ms as for make_drives()
[[nodiscard]] std::vector<std::string> lacks_of_record(const device::Device& device, int watchdog_ms);

/// What kind of bus these drives need.
[[nodiscard]] can::Network network_of(const device::Device& device) noexcept;

/// Whether it is known that the drives end the last torque by themselves when the controller falls silent.
[[nodiscard]] bool have_watchdog(const device::Device& device) noexcept;

}  // namespace ligature::platform
