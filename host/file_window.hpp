#pragma once
#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "host/regular_file.hpp"

namespace ligature::host {

/// Buffered random access to a file: the block read last stays in memory, so that small steps need few system calls.
class FileWindow {
 public:
  static constexpr std::size_t kBlock = 1U << 18U;

  explicit FileWindow(const RegularFile& file) : file_(file) {}

  /// The bytes at `offset`, fewer at the end of the file; valid until the next call.
  [[nodiscard]] std::span<const unsigned char> at(std::int64_t offset, std::size_t bytes) {
    const auto end = [&] { return start_ + static_cast<std::int64_t>(held_); };
    if (offset < start_ || offset + static_cast<std::int64_t>(bytes) > end()) {
      buffer_.resize(std::max(bytes, kBlock));
      held_ = file_.read_at(buffer_.data(), buffer_.size(), offset);
      start_ = offset;
    }
    const auto from = static_cast<std::size_t>(offset - start_);
    return std::span<const unsigned char>(buffer_).subspan(from, std::min(bytes, held_ - from));
  }

 private:
  const RegularFile& file_;
  std::vector<unsigned char> buffer_;
  std::int64_t start_ = 0;
  std::size_t held_ = 0;
};

}  // namespace ligature::host
