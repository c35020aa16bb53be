#pragma once
#include <chrono>
#include <cstdint>

namespace ligature::host {

/// CLOCK_REALTIME in us: the `utime` of messages and the timestamp of log events.
[[nodiscard]] inline std::int64_t now_us() {
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  return std::chrono::duration_cast<std::chrono::microseconds>(now).count();
}

}  // namespace ligature::host
