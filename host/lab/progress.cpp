#include "host/lab/progress.hpp"

#include <unistd.h>

#include <algorithm>
#include <cstdio>

namespace ligature::lab {

Progress::Progress() : terminal_(isatty(STDERR_FILENO) == 1) {}

Progress::~Progress() {
  if (shown_) std::fputs("\r\033[K", stderr);
}

bool Progress::is_due() {
  if (!terminal_ || ++calls_ % 64 != 0) return false;
  const auto now = std::chrono::steady_clock::now();
  if (now - last_ < std::chrono::milliseconds(150)) return false;
  last_ = now;
  return true;
}

void Progress::show(double share, const std::string& text) {
  if (!terminal_) return;
  constexpr int kWidth = 30;
  const int full = static_cast<int>(std::clamp(share, 0.0, 1.0) * kWidth);
  const std::string bar =
      std::string(static_cast<std::size_t>(full), '#') + std::string(static_cast<std::size_t>(kWidth - full), '.');
  std::fprintf(stderr, "\r\033[K[%s] %3.0f %%  %s", bar.c_str(), 100.0 * share, text.c_str());
  std::fflush(stderr);
  shown_ = true;
}

}  // namespace ligature::lab
