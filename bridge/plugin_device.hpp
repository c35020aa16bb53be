#pragma once
#include <string>

#include "bridge/device.hpp"

namespace ligature::bridge {

/// A device behind a shared library that implements backend.h.
[[nodiscard]] OpenedDevice open_plugin(const std::string& library, const std::string& address);

}  // namespace ligature::bridge
