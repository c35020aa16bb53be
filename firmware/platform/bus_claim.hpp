#pragma once
// Ensures that only one controller on this machine uses a bus. A controller takes the claim before it sends its first
// frame.

#include <string>
#include <utility>
#include <variant>

namespace ligature::platform {

/// A name that only one process can hold at a time. It is an abstract Unix socket, so the kernel frees it however the
/// process ends and no file remains. Abstract names are per network namespace, as CAN interfaces are.
class BusClaim {
 public:
  BusClaim() = default;
  /// @return the claim, or one line that says why not, with the process that holds it.
  [[nodiscard]] static std::variant<BusClaim, std::string> take(const std::string& name);

  ~BusClaim();
  BusClaim(BusClaim&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
  BusClaim& operator=(BusClaim&& other) noexcept {
    std::swap(fd_, other.fd_);
    return *this;
  }

 private:
  explicit BusClaim(int fd) noexcept : fd_(fd) {}
  int fd_ = -1;
};

}  // namespace ligature::platform
