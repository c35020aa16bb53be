#include "host/lab/stop_signal.hpp"

#include <csignal>

namespace ligature::lab {
namespace {

volatile std::sig_atomic_t stop = 0;

}  // namespace

void watch_stop_signals() {
  struct sigaction action {};
  action.sa_handler = [](int) { stop = 1; };
  sigemptyset(&action.sa_mask);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  std::signal(SIGXFSZ, SIG_IGN);  // a file that may not grow is an error of writing like a full disk
}

bool stop_requested() noexcept { return stop != 0; }

}  // namespace ligature::lab
