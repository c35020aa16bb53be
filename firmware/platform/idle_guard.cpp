#include "firmware/platform/idle_guard.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <cstring>

namespace ligature::platform {

IdleGuard::IdleGuard(const char* device) : fd_(open(device, O_WRONLY | O_CLOEXEC)) {
  const std::int32_t longest_us = 0;
  if (fd_ >= 0 && write(fd_, &longest_us, sizeof longest_us) == sizeof longest_us) return;
  refusal_ = std::string("short idle states (") + device + ") refused (" + std::strerror(errno) +
             "); remedy: the package's udev rule and the group 'realtime', or no idle states: cpupower idle-set -D 20";
}

IdleGuard::~IdleGuard() {
  if (fd_ >= 0) close(fd_);
}

}  // namespace ligature::platform
