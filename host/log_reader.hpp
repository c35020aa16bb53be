#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "host/console/progress.hpp"
#include "host/file_window.hpp"
#include "host/log_format.hpp"
#include "host/messages.hpp"
#include "host/regular_file.hpp"

namespace ligature::host {

/// One event of a log. The members point into the reader and are valid until its next call.
struct LogEvent {
  std::int64_t timestamp_us = 0;  // CLOCK_REALTIME at reception
  std::string_view channel;
  Bytes data;
};

/// Reads an LCM event log (layout: log_format.hpp) front to back in constant memory.
/// LCM's own reader is not used: it cannot tell the end of a file from a damaged event, allocates as much as a damaged
/// length asks for, and prints to stderr. This one continues at the next intact event and counts the bytes skipped. An
/// event with a wrong checksum is counted and dropped. A stop signal ends reading with RunFailed.
class LogReader {
 public:
  /// @param progress display of the position in the file; may be null.
  /// @throws BadInput when the file cannot be read or does not begin like an LCM log.
  explicit LogReader(const std::string& path, console::Progress* progress = nullptr);

  LogReader(const LogReader&) = delete;
  LogReader& operator=(const LogReader&) = delete;

  /// @return the next complete event, nullptr at the end. @throws RunFailed on a stop signal.
  const LogEvent* next();

  [[nodiscard]] std::int64_t offset() const { return offset_; }  ///< bytes read
  [[nodiscard]] std::int64_t size() const { return file_.size(); }
  [[nodiscard]] std::int64_t events() const { return events_; }        ///< returned by next()
  [[nodiscard]] std::int64_t damaged() const { return damaged_; }      ///< events dropped: wrong checksum
  [[nodiscard]] std::int64_t unchecked() const { return unchecked_; }  ///< events dropped: no checksum of their own
  [[nodiscard]] std::int64_t skipped_bytes() const { return skipped_bytes_; }  ///< damaged bytes between intact events
  [[nodiscard]] bool is_truncated() const { return tail_bytes_ > 0; }          ///< the last event is cut off
  [[nodiscard]] std::int64_t tail_bytes() const { return tail_bytes_; }

  /// One line about the damage; empty for an intact file.
  [[nodiscard]] std::string damage() const;

 private:
  bool read_event_at(std::int64_t offset);
  [[nodiscard]] static bool is_whole(std::span<const unsigned char> behind);
  [[nodiscard]] static bool is_like_check(std::span<const unsigned char> behind);

  RegularFile file_;
  FileWindow window_{file_};
  console::Progress* progress_;
  std::int64_t offset_ = 0, events_ = 0, skipped_bytes_ = 0, tail_bytes_ = 0, damaged_ = 0, unchecked_ = 0;
  bool has_checks_ = false;
  LogEvent event_;
};

}  // namespace ligature::host
