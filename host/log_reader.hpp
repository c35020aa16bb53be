#pragma once
#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "host/messages.hpp"

namespace ligature::host {

/// One event of a log; views into the reader, valid until its next call.
struct LogEvent {
  std::int64_t timestamp_us = 0;  // CLOCK_REALTIME at reception
  std::string_view channel;
  Bytes data;
};

/// Reads an LCM event log front to back in constant memory.
/// log_format.hpp has the layout.
/// Ours and not the library's reader: that one cannot tell the end of a file from a broken event, allocates what a
/// broken length says and prints to stderr. This one goes on at the next sound event and says how much it skipped.
class LogReader {
 public:
  /// @throws BadInput when the file cannot be read or does not begin like an LCM log.
  explicit LogReader(const std::string& path);

  /// @return the next whole event, nullptr at the end.
  const LogEvent* next();

  [[nodiscard]] std::int64_t offset() const { return offset_; }  ///< bytes read
  [[nodiscard]] std::int64_t size() const { return size_; }      ///< bytes in all
  [[nodiscard]] std::int64_t events() const { return events_; }
  [[nodiscard]] std::int64_t skipped_bytes() const { return skipped_bytes_; }  ///< between sound events
  [[nodiscard]] bool is_truncated() const { return tail_bytes_ > 0; }          ///< the last event is cut off
  [[nodiscard]] std::int64_t tail_bytes() const { return tail_bytes_; }

  /// One line about what is damaged; empty for a sound file.
  [[nodiscard]] std::string damage() const;

 private:
  struct Closer {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  bool read_event_at(std::int64_t offset);
  std::int64_t find_sync(std::int64_t from);

  std::unique_ptr<std::FILE, Closer> file_;
  std::int64_t size_ = 0, offset_ = 0, events_ = 0, skipped_bytes_ = 0, tail_bytes_ = 0;
  std::vector<std::byte> payload_;
  std::string channel_;
  LogEvent event_;
};

}  // namespace ligature::host
