#include "firmware/app/drive_checks.hpp"

#include "firmware/platform/make_drives.hpp"
#include "protocol/device/device_file.hpp"

namespace ligature::app {

std::variant<std::vector<platform::Check>, std::string> drive_checks(const std::string& device_file, int watchdog_ms) {
  const auto loaded = device::load_device(device_file);
  if (const auto* error = std::get_if<scene::Error>(&loaded)) return error->text;
  const auto& device = std::get<device::Device>(loaded);
  std::vector<platform::Check> rows;
  for (const std::string& line : platform::lacks_of_record(device, watchdog_ms))
    rows.push_back({platform::Grade::kWarn, "drives", line, {}});
  if (!platform::have_watchdog(device))
    rows.push_back({platform::Grade::kWarn, "drives", "run needs --accept-no-drive-watchdog",
                    "an emergency stop on the drives' power supply (docs/drives.md)"});
  if (rows.empty()) rows.push_back({platform::Grade::kOk, "drives", device.name + ": nothing is missing", {}});
  return rows;
}

bool need_fd(const std::string& device_file) {
  const auto loaded = device::load_device(device_file);
  const auto* const device = std::get_if<device::Device>(&loaded);
  return device != nullptr && platform::network_of(*device) == can::Network::kFd;
}

}  // namespace ligature::app
