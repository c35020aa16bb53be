#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "protocol/recorder/crc32.hpp"

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
inline constexpr std::int32_t kLongestChannel = 63;  ///< LCM_MAX_CHANNEL_NAME_LENGTH
inline constexpr std::int32_t kLargestData = 16
                                             << 20;  ///< bytes of data per event; the rig's messages have about 10 KB

// LCM's log format has no checksum. Therefore a checksum event follows each event that we write, on a channel that
// other readers ignore. Its data: the big-endian int64 timestamp of the event, and the CRC-32 of its channel and data.
inline constexpr std::string_view kCheckChannel = "LIGATURE_CHECK";
inline constexpr std::size_t kCheckBytes = 12;  ///< size of the checksum event's data
inline constexpr std::size_t kCheckEventBytes = 28 + kCheckChannel.size() + kCheckBytes;

[[nodiscard]] constexpr std::uint32_t log_checksum(std::string_view channel, std::span<const std::byte> data) noexcept {
  std::uint32_t sum = 0;
  for (const char c : channel) {
    const std::byte byte{static_cast<unsigned char>(c)};
    sum = recorder::crc32(std::span(&byte, 1), sum);
  }
  return recorder::crc32(data, sum);
}

/// Decodes an event's head. Nothing when the bytes do not start with the sync word, or when the lengths are out of
/// range.
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

/// Content of a checksum event; it belongs to the event before it.
struct LogCheck {
  std::int64_t timestamp_us = 0;
  std::uint32_t checksum = 0;
};

/// Decodes a checksum event. Nothing when there is none, or when the event's own timestamp differs from the timestamp
/// in its data. (That happens in a log that was played back and recorded again: those checksum events are ignored.)
[[nodiscard]] constexpr std::optional<LogCheck> log_check(std::span<const unsigned char> bytes) noexcept {
  if (bytes.size() < kCheckEventBytes) return std::nullopt;
  const auto head = log_event_head(bytes.first<LogEventHead::kBytes>());
  if (!head || head->channel_bytes != static_cast<std::int32_t>(kCheckChannel.size()) ||
      head->data_bytes != static_cast<std::int32_t>(kCheckBytes))
    return std::nullopt;
  bytes = bytes.subspan(LogEventHead::kBytes);
  for (std::size_t i = 0; i < kCheckChannel.size(); ++i)
    if (bytes[i] != static_cast<unsigned char>(kCheckChannel[i])) return std::nullopt;
  bytes = bytes.subspan(kCheckChannel.size());
  std::uint64_t timestamp = 0;
  std::uint32_t checksum = 0;
  for (std::size_t i = 0; i < 8; ++i) timestamp = timestamp << 8U | bytes[i];
  for (std::size_t i = 8; i < kCheckBytes; ++i) checksum = checksum << 8U | bytes[i];
  if (static_cast<std::int64_t>(timestamp) != head->timestamp_us) return std::nullopt;
  return LogCheck{static_cast<std::int64_t>(timestamp), checksum};
}

/// Whether the log was recorded with checksums, judged by its first bytes.
[[nodiscard]] constexpr bool has_checksums(std::span<const unsigned char> beginning) noexcept {
  for (; beginning.size() >= kCheckEventBytes; beginning = beginning.subspan(1))
    if (beginning[0] == kLogSync[0] && log_check(beginning)) return true;
  return false;
}
/// Number of bytes that has_checksums() needs: they hold several messages of the rig.
inline constexpr std::size_t kBeginning = 1U << 16U;

[[nodiscard]] constexpr std::array<std::byte, kCheckBytes> encoded(const LogCheck& check) noexcept {
  std::array<std::byte, kCheckBytes> bytes{};
  for (std::size_t i = 0; i < 8; ++i)
    bytes[i] = static_cast<std::byte>(static_cast<std::uint64_t>(check.timestamp_us) >> (56 - 8 * i));
  for (std::size_t i = 8; i < kCheckBytes; ++i) bytes[i] = static_cast<std::byte>(check.checksum >> (88 - 8 * i));
  return bytes;
}

}  // namespace ligature::host
