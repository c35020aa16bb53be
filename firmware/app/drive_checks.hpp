#pragma once

#include <string>
#include <variant>
#include <vector>

#include "firmware/platform/machine.hpp"

namespace ligature::app {

/// Rows of doctor's table about the drives of a device record: one row for each safety function that the drives lack,
/// such as a watchdog of `watchdog_ms`. @return the rows, or one line of text if the record cannot be read.
[[nodiscard]] std::variant<std::vector<platform::Check>, std::string> drive_checks(const std::string& device_file,
                                                                                   int watchdog_ms);

/// Whether the drives of a record that can be read speak CAN FD.
[[nodiscard]] bool need_fd(const std::string& device_file);

}  // namespace ligature::app
