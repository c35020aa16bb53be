#pragma once
// Prevents deep idle states of the CPU while force may flow: leaving such a state takes time and would delay every
// wake-up.

#include <string>

namespace ligature::platform {

/// Holds /dev/cpu_dma_latency open with a request of 0 us (the kernel's PM QoS): cores then use only idle states that
/// they leave at once. The request ends with this object, or with the process.
class IdleGuard {
 public:
  explicit IdleGuard(const char* device = "/dev/cpu_dma_latency");
  ~IdleGuard();
  IdleGuard(const IdleGuard&) = delete;
  IdleGuard& operator=(const IdleGuard&) = delete;

  /// Empty if granted; else one line with what was refused, why, and the remedy.
  [[nodiscard]] const std::string& refusal() const noexcept { return refusal_; }

 private:
  int fd_;
  std::string refusal_;
};

}  // namespace ligature::platform
