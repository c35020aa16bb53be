#pragma once
// Signals that end the program.

#include <signal.h>

namespace ligature::app {

/// Blocks SIGINT and SIGTERM, so that the main thread can wait for them; no asynchronous signal handler is needed.
class StopSignals {
 public:
  StopSignals() {
    sigemptyset(&set_);
    sigaddset(&set_, SIGINT);
    sigaddset(&set_, SIGTERM);
    pthread_sigmask(SIG_BLOCK, &set_, nullptr);  // threads started later inherit this
  }
  /// Waits for a signal, at most 50 ms. @return true if one has arrived.
  bool wait() const {
    const timespec patience{0, 50'000'000};
    return sigtimedwait(&set_, nullptr, &patience) > 0;
  }

 private:
  sigset_t set_;
};

}  // namespace ligature::app
