#pragma once
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string_view>
#include <vector>

namespace ligature::host::view {

static_assert(std::endian::native == std::endian::little, "the page reads little-endian");

/// Kinds of sections in a frame (docs/view.md); page/frame.js decodes them.
enum class Section : std::uint32_t {
  kNow = 1,
  kShape = 2,
  kRows = 3,
  kBins = 4,
  kText = 5,
  kBeside = 6,
  kBesideRows = 7,
  kBesideBins = 8
};

/// Builds one binary WebSocket message: "LGF1", u32 frame number, then sections of u32 kind, u32 size in bytes and
/// payload. Sections are padded to 8 bytes, so that the page can use typed arrays on the message without copying.
class FrameWriter {
 public:
  explicit FrameWriter(std::uint32_t number) {
    add_bytes("LGF1", 4);
    add(number);
  }

  void begin(Section kind) {
    add(static_cast<std::uint32_t>(kind));
    add(std::uint32_t{0});
    start_ = bytes_.size();
  }
  void end() {
    const auto size = static_cast<std::uint32_t>(bytes_.size() - start_);
    std::memcpy(bytes_.data() + start_ - sizeof size, &size, sizeof size);
    bytes_.resize((bytes_.size() + 7) / 8 * 8);
  }

  template <class T>
  void add(const T& value) {
    add_bytes(&value, sizeof value);
  }
  void add_text(std::string_view text) { add_bytes(text.data(), text.size()); }
  void add_bytes(const void* data, std::size_t size) {
    const auto* first = static_cast<const std::byte*>(data);
    bytes_.insert(bytes_.end(), first, first + size);
  }

  [[nodiscard]] std::vector<std::byte> take() { return std::move(bytes_); }

 private:
  std::vector<std::byte> bytes_;
  std::size_t start_ = 0;
};

}  // namespace ligature::host::view
