#pragma once
// CRC-32 as in IEEE 802.3 and zlib: reflected, polynomial 0xEDB88320.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace ligature::recorder {
namespace detail {

consteval std::array<std::uint32_t, 256> crc_table() {
  std::array<std::uint32_t, 256> table{};
  for (std::uint32_t i = 0; i < 256; ++i) {
    std::uint32_t c = i;
    for (int bit = 0; bit < 8; ++bit) c = (c & 1U) != 0 ? 0xEDB88320U ^ (c >> 1U) : c >> 1U;
    table[i] = c;
  }
  return table;
}
inline constexpr auto kCrcTable = crc_table();

}  // namespace detail

/// @param before the CRC of the preceding bytes; 0 for none. @return the CRC of all together. One table look-up per
/// byte.
[[nodiscard]] constexpr std::uint32_t crc32(std::span<const std::byte> bytes, std::uint32_t before = 0) noexcept {
  std::uint32_t c = ~before;
  for (const std::byte b : bytes) c = detail::kCrcTable[(c ^ std::to_integer<std::uint32_t>(b)) & 0xFFU] ^ (c >> 8U);
  return ~c;
}

}  // namespace ligature::recorder
