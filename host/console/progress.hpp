#pragma once
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <string>

namespace ligature::console {

/// How far a long work is, as one line rewritten in place; silent where nobody watches.
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

  /// For steps by the thousand: looks at the clock only now and then, and says nothing in the first second.
  void show(std::int64_t done, std::int64_t whole) {
    if (is_due() && whole > 0) show(static_cast<double>(done) / static_cast<double>(whole), std::string());
  }
  /// Is another line due? For those who make its words only then. Cheap enough for every tick.
  [[nodiscard]] bool is_due() { return is_on_ && ++calls_ % 64 == 0 && is_due(Clock::now()); }
  [[nodiscard]] bool is_due(Clock::time_point now);
  /// For steps that take long: shown at once.  @param share 0 .. 1 done;  @param step what is going on, a short phrase.
  void show(double share, const std::string& step) { show(share, step, Clock::now()); }
  void show(double share, const std::string& step, Clock::time_point now);
  /// A step that has no measure, "making the MCAP file".
  void say(const char* step);

 private:
  const char* what_;
  std::FILE* out_;
  bool is_on_, has_line_ = false;
  unsigned calls_ = 0;
  Clock::time_point start_, shown_;
};

}  // namespace ligature::console
