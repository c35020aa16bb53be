#pragma once
#include <fcntl.h>
#include <unistd.h>

namespace ligature::lcm_tools {

/// Suppresses the long message that LCM prints to stderr if the network fails; our programs print one line instead.
class QuietStderr {
 public:
  QuietStderr() : saved_(dup(STDERR_FILENO)), null_(open("/dev/null", O_WRONLY | O_CLOEXEC)) {
    if (saved_ >= 0 && null_ >= 0) dup2(null_, STDERR_FILENO);
  }
  ~QuietStderr() {
    if (saved_ >= 0) dup2(saved_, STDERR_FILENO);
    close(saved_);
    close(null_);
  }
  QuietStderr(const QuietStderr&) = delete;
  QuietStderr& operator=(const QuietStderr&) = delete;

 private:
  int saved_, null_;
};

}  // namespace ligature::lcm_tools
