#pragma once
// Reads device records from TOML, as strictly as scene files. Each number states its source:
//   peak_force_N = {value = 3.3, source = "datasheet"}          source: "measured" | "datasheet" | "assumed"

#include <filesystem>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "protocol/device/device.hpp"
#include "protocol/scene/scene.hpp"

namespace ligature::device {

/// A record and the source of each value, by dotted key, in the file's order.
struct DeviceFile {
  Device device;
  std::vector<std::pair<std::string, Source>> sources;
};

/// @return the record, or one line that says what is wrong: file, line, key, what was found, what is allowed. All keys
/// must be present, except drives.torque_tolerance_permille.
[[nodiscard]] std::variant<DeviceFile, scene::Error> load_device_file(const std::filesystem::path& path);
[[nodiscard]] std::variant<Device, scene::Error> load_device(const std::filesystem::path& path);
/// Parses a device record from a text; result as load_device_file(). `name` is used as file name in messages.
[[nodiscard]] std::variant<DeviceFile, scene::Error> parse_device(const std::string& toml, const std::string& name);

}  // namespace ligature::device
