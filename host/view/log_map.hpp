#pragma once
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "host/regular_file.hpp"

namespace ligature::host::view {

/// Where the messages of a log lie, so that any moment can be played without reading what is before it.
/// Only headers are read: 32 bytes are kept of each message of ours (about 14 MB for an hour), and the payload is read
/// when it is played. Broken stretches are skipped up to the next sound event, as host/log_reader.hpp does. A signal
/// ends the reading (RunFailed).
class LogMap {
 public:
  enum class Channel : std::uint8_t { kTicks, kThread, kStatus, kEvent };
  struct Entry {
    std::int64_t time_us;  // at reception, without what the clock on the wall was set by
    std::int64_t offset;   // of the payload
    std::uint32_t size;
    std::uint32_t checksum;  // of channel and payload
    Channel channel;
    bool has_checksum;
  };

  /// @throws BadInput when the file cannot be read, is no LCM log or holds no message of the rig.
  explicit LogMap(const std::string& path);

  [[nodiscard]] const std::vector<Entry>& entries() const { return entries_; }  ///< in order of time
  [[nodiscard]] double duration_s() const { return time_s(entries_.back().time_us); }
  [[nodiscard]] double time_s(std::int64_t time_us) const;  ///< since the first entry
  /// Index of the first entry later than t.
  [[nodiscard]] std::size_t after(double t_s) const;
  /// The payload of an entry; safe from several threads at once. @return false when the file has shrunk, or its
  /// checksum is wrong.
  bool read(const Entry& entry, std::vector<std::byte>& payload) const;

 private:
  void scan();

  RegularFile file_;
  std::vector<Entry> entries_;
};

/// Name of a channel on the wire.
[[nodiscard]] std::string_view wire_name(LogMap::Channel channel);

}  // namespace ligature::host::view
