#include "host/console/progress.hpp"

#include <unistd.h>

#include <algorithm>

namespace ligature::console {
namespace {

constexpr auto kQuietFor = std::chrono::seconds(1);
constexpr auto kEvery = std::chrono::milliseconds(250);

}  // namespace

Progress::Progress(const char* what, std::FILE* out, bool on, Clock::time_point start)
    : what_(what), out_(out), is_on_(on), start_(start), shown_(start) {}

Progress::Progress(const char* what, Clock::time_point start)
    : Progress(what, stderr, isatty(STDERR_FILENO) == 1, start) {}

Progress::~Progress() {
  if (has_line_) std::fputs("\r\033[K", out_);
}

bool Progress::is_due(Clock::time_point now) {
  if (now - start_ < kQuietFor || now - shown_ < kEvery) return false;
  shown_ = now;
  return true;
}

void Progress::show(double share, const std::string& step, Clock::time_point now) {
  if (!is_on_) return;
  has_line_ = true;
  share = std::clamp(share, 0.0, 1.0);
  const double passed_s = std::chrono::duration<double>(now - start_).count();
  std::fprintf(out_, "\r%s: %.0f %%", what_, 100.0 * share);
  if (share > 0.02) std::fprintf(out_, ", about %.0f s more", passed_s * (1.0 - share) / share);
  if (!step.empty()) std::fprintf(out_, " (%s)", step.c_str());
  std::fputs("\033[K", out_);
  std::fflush(out_);
}

}  // namespace ligature::console
