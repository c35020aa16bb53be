#include "sim_device/scheduling.hpp"

#include <sched.h>
#include <sys/mman.h>
#include <sys/prctl.h>

#include <cerrno>
#include <cstring>

namespace ligature::sim {
namespace {

// Below the controller's priority, which must never wait for the simulation
constexpr int kPriority = 40;
constexpr unsigned long kTimerSlack_ns = 1;  // the default of 50 us would delay every TPDO

}  // namespace

std::vector<std::string> ask_for_scheduling(bool real_time, int cpu) {
  std::vector<std::string> refused;
  const auto note = [&](bool ok, const std::string& what) {
    if (!ok) refused.push_back(what + " refused: " + std::strerror(errno));
  };
  note(prctl(PR_SET_TIMERSLACK, kTimerSlack_ns, 0, 0, 0) == 0, "timer slack of 1 ns");
  if (cpu >= 0) {
    cpu_set_t set;
    CPU_ZERO(&set);
    CPU_SET(static_cast<unsigned>(cpu), &set);
    note(sched_setaffinity(0, sizeof set, &set) == 0, "CPU " + std::to_string(cpu));
  }
  if (real_time) {
    sched_param parameters{};
    parameters.sched_priority = kPriority;
    note(sched_setscheduler(0, SCHED_FIFO, &parameters) == 0, "SCHED_FIFO");
    note(mlockall(MCL_CURRENT | MCL_FUTURE) == 0, "locked memory");
  }
  return refused;
}

}  // namespace ligature::sim
