#pragma once
// Writes a rerun as a recording of its own, for `ligature-host replay` and other readers.

#include <cstdint>
#include <string>
#include <vector>

#include "host/log_reader.hpp"
#include "host/log_writer.hpp"
#include "ligature_msg/status_t.hpp"
#include "ligature_msg/thread_t.hpp"
#include "ligature_msg/tick_batch_t.hpp"

namespace ligature::lab {

/// A copy of the recorded log, with the same times; the thread's data in it are those of the rerun.
class RerunLog {
 public:
  /// @throws host::BadInput when the file exists or cannot be made.
  RerunLog(const std::string& path, std::vector<std::string> overrides)
      : log_(path, false), overrides_(std::move(overrides)) {}

  void begin(const host::LogEvent& event) { at_us_ = event.timestamp_us; }
  void add(const ligature_msg::tick_t& tick) { ticks_.push_back(tick); }
  void add(ligature_msg::thread_t shape, std::int64_t utime);
  /// Writes a status message; the rerun's overrides are appended to its scene text.
  void add(ligature_msg::status_t status);
  void copy(const host::LogEvent& event) { log_.write(at_us_, event.channel, event.data); }
  /// Writes the ticks added since the last batch. @param like the batch whose other fields are copied.
  void end_batch(const ligature_msg::tick_batch_t& like);
  void close() { log_.close(); }

 private:
  template <class Message>
  void write(std::string_view channel, const Message& message);

  host::LogWriter log_;
  std::vector<std::string> overrides_;
  std::vector<ligature_msg::tick_t> ticks_;
  std::int64_t at_us_ = 0;
  std::vector<std::byte> bytes_;
};

}  // namespace ligature::lab
