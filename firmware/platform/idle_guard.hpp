#pragma once
// No deep sleep while force may flow: a core that must first come back from a deep idle state is late every time.

#include <string>

namespace ligature::platform {

/// Holds /dev/cpu_dma_latency open with a request of 0 us (the kernel's PM QoS): from then on cores only idle in states
/// that they leave at once. The request ends with this object, or with the process.
class IdleGuard {
 public:
  explicit IdleGuard(const char* device = "/dev/cpu_dma_latency");
  ~IdleGuard();
  IdleGuard(const IdleGuard&) = delete;
  IdleGuard& operator=(const IdleGuard&) = delete;

  /// Empty when granted; else one line: what, why and the remedy.
  [[nodiscard]] const std::string& refusal() const noexcept { return refusal_; }

 private:
  int fd_;
  std::string refusal_;
};

}  // namespace ligature::platform
