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
  /// @param replace whether a file of that name may be replaced.
  /// @throws BadInput when it may not, or the file cannot be made.
  LogWriter(std::string path, bool replace);
  ~LogWriter();

  /// Hands one event to the operating system: when this returns, the end of this process loses nothing of it.
  /// (One system call each; the rig sends about 120 events a second.)
  /// @throws RunFailed when the disk does not take it; what it took before is kept.
  void write(std::int64_t timestamp_us, std::string_view channel, Bytes data);
  /// Puts everything on the disk and closes. @throws RunFailed.
  void close();

  [[nodiscard]] std::int64_t bytes() const { return bytes_; }

 private:
  [[noreturn]] void fail() const;

  std::string path_;
  std::unique_ptr<lcm::LogFile> file_;
  std::int64_t bytes_ = 0;
};

}  // namespace ligature::host
