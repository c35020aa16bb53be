#pragma once
#include <chrono>
#include <cstdint>
#include <cstdio>

namespace ligature::host {

/// How far a long work is, as one line rewritten in place; silent where nobody watches, and for the first second.
class Progress {
 public:
  using Clock = std::chrono::steady_clock;

  /// @param what the work, as a word: "export".  @param on whether `out` is a terminal.
  Progress(const char* what, std::FILE* out, bool on, Clock::time_point start = Clock::now());
  /// On the standard error output, when that is a terminal.
  explicit Progress(const char* what);
  /// Wipes the line.
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// Cheap enough for every message: looks at the clock only now and then.
  void show(std::int64_t done, std::int64_t whole) {
    if (is_on_ && ++calls_ % 64 == 0) show(done, whole, Clock::now());
  }
  void show(std::int64_t done, std::int64_t whole, Clock::time_point now);
  /// A step that has no measure, "making the MCAP file".
  void say(const char* step);

 private:
  const char* what_;
  std::FILE* out_;
  bool is_on_, has_line_ = false;
  unsigned calls_ = 0;
  Clock::time_point start_, shown_;
};

}  // namespace ligature::host
