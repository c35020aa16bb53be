#pragma once
// The bytes of MCAP records: opcode, length, content; integers are little-endian.

#include <concepts>
#include <cstdint>
#include <string>
#include <string_view>

namespace ligature::host::mcap {

enum class Op : std::uint8_t {
  kHeader = 0x01,
  kFooter = 0x02,
  kSchema = 0x03,
  kChannel = 0x04,
  kMessage = 0x05,
  kChunk = 0x06,
  kMessageIndex = 0x07,
  kChunkIndex = 0x08,
  kAttachment = 0x09,
  kAttachmentIndex = 0x0A,
  kStatistics = 0x0B,
  kMetadata = 0x0C,
  kMetadataIndex = 0x0D,
  kSummaryOffset = 0x0E,
  kDataEnd = 0x0F,
};

inline constexpr std::string_view kMagic = "\x89MCAP0\r\n";

template <std::unsigned_integral T>
void put_number(std::string& to, T value) {
  for (std::size_t i = 0; i < sizeof(T); ++i) to += static_cast<char>(value >> (8U * i) & 0xFFU);
}

inline void put_text(std::string& to, std::string_view text) {
  put_number(to, static_cast<std::uint32_t>(text.size()));
  to += text;
}

inline void put_record_head(std::string& to, Op op, std::uint64_t content_bytes) {
  to += static_cast<char>(op);
  put_number(to, content_bytes);
}

[[nodiscard]] inline std::string record(Op op, std::string_view content) {
  std::string bytes;
  put_record_head(bytes, op, content.size());
  bytes += content;
  return bytes;
}

}  // namespace ligature::host::mcap
