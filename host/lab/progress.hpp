#pragma once

#include <chrono>
#include <string>

namespace ligature::lab {

/// One line on stderr that rewrites itself a few times a second; silent when stderr is not a terminal.
class Progress {
 public:
  Progress();
  ~Progress();  ///< clears the line
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// Is it time for another show()? Cheap enough for every tick.
  [[nodiscard]] bool is_due();
  /// @param share 0 .. 1 done;  @param text what is going on, one short phrase.
  void show(double share, const std::string& text);

 private:
  bool terminal_;
  bool shown_ = false;
  unsigned calls_ = 0;
  std::chrono::steady_clock::time_point last_{};
};

}  // namespace ligature::lab
