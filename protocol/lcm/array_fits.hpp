#pragma once
// Checks the array lengths inside an LCM message before it is decoded. LCM's generated decoders trust these lengths: a
// forged one would allocate gigabytes or read past the end of the message.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace ligature::lcm_tools {

inline constexpr std::size_t kHash = 8, kInt64 = 8, kInt32 = 4, kInt8 = 1, kFloat = 4;  ///< encoded sizes in bytes

/// The big-endian int32 at an offset; nothing when the message is too short.
[[nodiscard]] inline std::optional<std::int32_t> int32_at(std::span<const std::byte> message, std::size_t offset) {
  if (message.size() < offset + kInt32) return std::nullopt;
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < kInt32; ++i) value = value << 8U | std::to_integer<std::uint32_t>(message[offset + i]);
  return static_cast<std::int32_t>(value);
}

/// Whether the message has exactly the length that an array with its count at `count_offset` and a tail of fixed size
/// need.
[[nodiscard]] inline bool array_fits(std::span<const std::byte> message, std::size_t count_offset,
                                     std::size_t element_size, std::size_t tail_size) {
  const auto count = int32_at(message, count_offset);
  if (!count || *count < 0) return false;
  return message.size() == count_offset + kInt32 + static_cast<std::size_t>(*count) * element_size + tail_size;
}

/// As array_fits(), for tick_batch_t: hash, utime, session, ring_dropped, count, ticks. @param tick_size bytes of one
/// tick_t
[[nodiscard]] inline bool tick_batch_fits(std::span<const std::byte> message, std::size_t tick_size) {
  return array_fits(message, kHash + 3 * kInt64, tick_size, 0);
}

/// As array_fits(), for thread_t. It has three values per node, each in an array of the same length: position, tension
/// and turn (twist angle).
[[nodiscard]] inline bool thread_fits(std::span<const std::byte> message) {
  return array_fits(message, kHash + 2 * kInt64 + kFloat, 5 * kFloat, 2 * sizeof(std::int16_t));
}

}  // namespace ligature::lcm_tools
