#pragma once

#include <string>
#include <variant>
#include <vector>

#include "firmware/platform/machine.hpp"

namespace ligature::app {

/// What the drives of a device record cannot promise, as rows of doctor's table. @return one line if the file is bad.
[[nodiscard]] std::variant<std::vector<platform::Check>, std::string> drive_checks(const std::string& device_file);

}  // namespace ligature::app
