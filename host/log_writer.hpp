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

/// Writes an LCM event log (as lcm-logger does; lcm-logplayer plays it).
class LogWriter {
 public:
  /// The file is locked as long as this lives (flock): two writers would mix their events.
  /// @param replace whether a file of that name may be replaced.
  /// @throws BadInput when it may not, the file cannot be made, or somebody else writes it.
  LogWriter(std::string path, bool replace);
  ~LogWriter();

  /// Whether an event is fit for a log: no larger than readers take, and not on the channel of the checksums.
  [[nodiscard]] static bool takes(std::string_view channel, Bytes data);
  /// Hands one event to the operating system: when this returns, the end of this process loses nothing of it.
  /// Its checksum follows it (host/log_format.hpp). (One system call for both, two for a large one; the rig sends about
  /// 120 events a second.)
  /// @throws RunFailed when the disk does not take it; what it took before is kept.
  void write(std::int64_t timestamp_us, std::string_view channel, Bytes data);
  /// Puts everything on the disk and closes. @throws RunFailed.
  void close();

  [[nodiscard]] std::int64_t bytes() const { return bytes_; }

 private:
  /// A descriptor that holds the lock until it is closed.
  class Lock {
   public:
    Lock(const std::string& path, bool replace);
    ~Lock();
    Lock(const Lock&) = delete;
    Lock& operator=(const Lock&) = delete;
    [[nodiscard]] bool is_of(int file) const;

   private:
    int file_;
  };
  void append(std::int64_t timestamp_us, std::string_view channel, Bytes data);
  [[noreturn]] void fail() const;

  std::string path_;
  Lock lock_;  // before anything is truncated
  std::unique_ptr<lcm::LogFile> file_;
  std::int64_t bytes_ = 0;
};

}  // namespace ligature::host
