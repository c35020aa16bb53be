#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "host/messages.hpp"

namespace lcm {
class LogFile;
}

namespace ligature::host {

/// Writes an LCM event log, as lcm-logger does; lcm-logplayer can play it.
class LogWriter {
 public:
  /// Locks the file (flock) for the lifetime of this object, because two writers would mix their events.
  /// @param replace whether an existing file may be replaced; it stays as it is until the first write().
  /// @throws BadInput when the file exists and `replace` is false, when it cannot be created, or when another process
  /// writes it.
  LogWriter(std::string path, bool replace);
  ~LogWriter();

  /// Whether an event may be logged: not larger than readers accept, and not on the checksum channel.
  [[nodiscard]] static bool takes(std::string_view channel, Bytes data);
  /// Passes one event and its checksum (host/log_format.hpp) to the operating system. After the return, the event
  /// survives the end of this process. Cost: one system call, two for a large event; the rig sends about 120 events a
  /// second.
  /// @throws RunFailed when writing fails (disk full); earlier events are kept. BadInput when the file to be replaced
  /// was itself replaced since the constructor.
  void write(std::int64_t timestamp_us, std::string_view channel, Bytes data);
  /// Flushes everything to the disk and closes the file. @throws RunFailed.
  void close();

  /// Bytes written; 0: a file that was to be replaced is still there.
  [[nodiscard]] std::int64_t bytes() const { return bytes_; }

 private:
  /// A file descriptor that holds the lock until it is closed.
  class Lock {
   public:
    Lock(const std::string& path, bool replace);
    ~Lock();
    Lock(const Lock&) = delete;
    Lock& operator=(const Lock&) = delete;
    [[nodiscard]] bool is_of(int file) const;
    [[nodiscard]] bool is_at(const std::string& path) const;

   private:
    int file_;
  };
  void begin();
  void append(std::int64_t timestamp_us, std::string_view channel, Bytes data);
  [[noreturn]] void fail() const;

  std::string path_;
  std::unique_ptr<Lock> lock_;
  std::unique_ptr<lcm::LogFile> file_;
  bool has_begun_ = false;
  std::int64_t bytes_ = 0;
};

}  // namespace ligature::host
