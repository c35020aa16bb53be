#pragma once
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <string>

namespace ligature::console {

/// Progress of a long task as one line that is rewritten in place; silent when the output is no terminal.
class Progress {
 public:
  using Clock = std::chrono::steady_clock;

  /// @param what the task in one word, such as "export".  @param on whether `out` is a terminal.
  Progress(const char* what, std::FILE* out, bool on, Clock::time_point start = Clock::now());
  /// Writes to standard error, when that is a terminal.  @param start of the task, for the time that is left
  explicit Progress(const char* what, Clock::time_point start = Clock::now());
  /// Erases the line.
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// For loops of thousands of short steps: reads the clock only at every 64th call, and prints nothing in the first
  /// second.
  void show(std::int64_t done, std::int64_t whole) {
    if (is_due() && whole > 0) show(static_cast<double>(done) / static_cast<double>(whole), std::string());
  }
  /// Whether the line should be printed again; lets a caller build its text only then. Cheap enough for every tick.
  [[nodiscard]] bool is_due() { return is_on_ && ++calls_ % 64 == 0 && is_due(Clock::now()); }
  [[nodiscard]] bool is_due(Clock::time_point now);
  /// For slow steps: printed at once.  @param share fraction done, 0 .. 1;  @param step the current step, a short
  /// phrase.
  void show(double share, const std::string& step) { show(share, step, Clock::now()); }
  void show(double share, const std::string& step, Clock::time_point now);

 private:
  const char* what_;
  std::FILE* out_;
  bool is_on_, has_line_ = false;
  unsigned calls_ = 0;
  Clock::time_point start_, shown_;
};

}  // namespace ligature::console
