#pragma once
// How the program is told to end.

#include <signal.h>

namespace ligature::app {

/// SIGINT and SIGTERM, taken by waiting for them in the main thread: no handler, nothing asynchronous anywhere.
class StopSignals {
 public:
  StopSignals() {
    sigemptyset(&set_);
    sigaddset(&set_, SIGINT);
    sigaddset(&set_, SIGTERM);
    pthread_sigmask(SIG_BLOCK, &set_, nullptr);  // threads started later inherit this
  }
  /// @return true when one came, within at most 50 ms.
  bool wait() const {
    const timespec patience{0, 50'000'000};
    return sigtimedwait(&set_, nullptr, &patience) > 0;
  }

 private:
  sigset_t set_;
};

}  // namespace ligature::app
