#pragma once
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "host/regular_file.hpp"

namespace ligature::host::view {

/// Index of the messages of a log, so that playback can start at any time without reading the messages before it.
/// Only heads are read: 32 bytes are kept per message (about 14 MB for an hour), and payloads are read when played.
/// Damaged parts are skipped up to the next intact event, as in host/log_reader.hpp. A stop signal ends the reading
/// (RunFailed).
class LogMap {
 public:
  enum class Channel : std::uint8_t { kTicks, kThread, kStatus, kEvent };
  struct Entry {
    std::int64_t time_us;  // reception time with steps of the system clock removed
    std::int64_t offset;   // position of the message's payload in the file
    std::uint32_t size;
    std::uint32_t checksum;  // CRC-32 of channel and payload
    Channel channel;
    bool has_checksum;
  };

  /// @throws BadInput when the file cannot be read, is no LCM log or holds no message of the rig.
  explicit LogMap(const std::string& path);

  /// One entry per message, in order of time
  [[nodiscard]] const std::vector<Entry>& entries() const { return entries_; }
  [[nodiscard]] double duration_s() const { return time_s(entries_.back().time_us); }
  [[nodiscard]] double time_s(std::int64_t time_us) const;  ///< since the first entry
  /// Index of the first entry later than t.
  [[nodiscard]] std::size_t after(double t_s) const;
  /// Reads the payload of an entry; thread-safe. @return false when the file has become shorter, or the checksum is
  /// wrong.
  bool read(const Entry& entry, std::vector<std::byte>& payload) const;

 private:
  void scan();

  RegularFile file_;
  std::vector<Entry> entries_;
};

/// LCM name of a channel.
[[nodiscard]] std::string_view wire_name(LogMap::Channel channel);

}  // namespace ligature::host::view
