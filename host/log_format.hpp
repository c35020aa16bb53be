#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace ligature::host {

/// Head of an event in an LCM log (LCM manual, "Log file format"), big-endian: the sync word 0xEDA1DA01, int64 event
/// number, int64 timestamp in us, int32 length of the channel, int32 length of the data; then channel and data.
struct LogEventHead {
  static constexpr std::size_t kBytes = 28;
  std::int64_t timestamp_us = 0;  ///< CLOCK_REALTIME at reception
  std::int32_t channel_bytes = 0;
  std::int32_t data_bytes = 0;
};

inline constexpr std::array<unsigned char, 4> kLogSync{0xED, 0xA1, 0xDA, 0x01};
inline constexpr std::int32_t kLongestChannel = 63;     ///< LCM_MAX_CHANNEL_NAME_LENGTH
inline constexpr std::int32_t kLargestData = 16 << 20;  ///< of one event; the rig's messages have some 10 KB

/// Nothing when the bytes do not begin with the sync word, or state lengths that no event has.
[[nodiscard]] constexpr std::optional<LogEventHead> log_event_head(
    std::span<const unsigned char, LogEventHead::kBytes> bytes) noexcept {
  const auto number = [&](std::size_t at, std::size_t size) {
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < size; ++i) value = value << 8U | bytes[at + i];
    return value;
  };
  for (std::size_t i = 0; i < kLogSync.size(); ++i) {
    if (bytes[i] != kLogSync[i]) return std::nullopt;
  }
  const LogEventHead head{static_cast<std::int64_t>(number(12, 8)), static_cast<std::int32_t>(number(20, 4)),
                          static_cast<std::int32_t>(number(24, 4))};
  if (head.channel_bytes < 1 || head.channel_bytes > kLongestChannel || head.data_bytes < 0 ||
      head.data_bytes > kLargestData)
    return std::nullopt;
  return head;
}

}  // namespace ligature::host
