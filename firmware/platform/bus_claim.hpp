#pragma once
// One controller a bus: who opens one on this machine holds it alone, before the first frame.

#include <string>
#include <utility>
#include <variant>

namespace ligature::platform {

/// A name that one process at a time can hold. The kernel takes it back when the process ends, however it ends, and
/// leaves nothing in the file system (an abstract Unix socket; one a network namespace, as CAN interfaces are).
class BusClaim {
 public:
  BusClaim() = default;
  /// @return the claim, or why not: in one line, with the process that holds it.
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
