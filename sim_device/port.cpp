#include "sim_device/port.hpp"

#include "sim_device/can_port.hpp"
#include "sim_device/local_port.hpp"

namespace ligature::sim {

std::variant<std::unique_ptr<Port>, std::string> open_port(const std::string& url, can::Network network) {
  const std::string local = "local:", socketcan = "socketcan:";
  if (url.starts_with(local)) return LocalPort::open(url.substr(local.size()), network);
  if (url.starts_with(socketcan)) return CanPort::open(url.substr(socketcan.size()), network);
  return "--bus: found '" + url + "', allowed local:/path/socket or socketcan:interface";
}

}  // namespace ligature::sim
