#include "host/console/stop_signal.hpp"

#include <signal.h>

namespace ligature::console {
namespace {

volatile sig_atomic_t g_stop = 0;

extern "C" void request_stop(int) { g_stop = 1; }

}  // namespace

void catch_stop_signals() {
  struct sigaction action = {};
  action.sa_handler = request_stop;  // no SA_RESTART: a waiting poll returns at once
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  signal(SIGXFSZ, SIG_IGN);
}

void outlive_closed_pipes() { signal(SIGPIPE, SIG_IGN); }

bool stop_requested() noexcept { return g_stop != 0; }

}  // namespace ligature::console
