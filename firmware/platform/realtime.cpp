#include "firmware/platform/realtime.hpp"

#include <malloc.h>
#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <string>

#include "firmware/platform/own_pages.hpp"

#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace ligature::platform {
namespace {

constexpr std::size_t kStackReserve = std::size_t{256} * 1024;
constexpr std::size_t kHeapReserve = std::size_t{8} * 1024 * 1024;
constexpr std::size_t kPage = 4096;

/// The last number of a core list such as "1,3-5"; -1 if it is empty.
int last_of(const std::string& list) {
  const auto at = list.find_last_of(",-");
  const std::string last = at == std::string::npos ? list : list.substr(at + 1);
  return last.empty() ? -1 : static_cast<int>(std::strtol(last.c_str(), nullptr, 10));
}

[[gnu::noinline]] void touch_stack() noexcept {
  unsigned char stack[kStackReserve];
  for (std::size_t i = 0; i < kStackReserve; i += kPage) stack[i] = 0;
  asm volatile("" : : "r"(stack) : "memory");  // keeps the compiler from removing the writes
}

/// Locks present and future memory. With a memlock limit it locks nothing, because allocations beyond the limit would
/// then fail.
/// @return 0, or the errno
int lock_all() noexcept {
  rlimit limit{};
  const bool bounded = getrlimit(RLIMIT_MEMLOCK, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY && geteuid() != 0;
  if (bounded) return ENOMEM;
  return mlockall(MCL_CURRENT | MCL_FUTURE) == 0 ? 0 : errno;
}

std::string refused(const char* what, int error, const char* remedy) {
  return std::string(what) + " refused (" + std::strerror(error) + "); remedy: " + remedy;
}

}  // namespace

Refusals lock_memory() {
  Refusals refusals;
  if (const int error = lock_all(); error != 0) {
    refusals.push_back(refused("locked memory (mlockall)", error, "memlock unlimited in limits.conf, or run as root"));
  }
  if (const int error = own_file_pages(); error != 0) {
    refusals.push_back(refused("copies of code and constants (madvise)", error,
                               "Linux 5.14 or newer, no MemoryDenyWriteExecute, no limit of data"));
  }
  const bool kept = mallopt(M_TRIM_THRESHOLD, -1) == 1 && mallopt(M_MMAP_MAX, 0) == 1;
  if (!kept) refusals.push_back("heap that keeps its pages (mallopt) refused; remedy: glibc's allocator");
  if (auto* reserve = static_cast<volatile unsigned char*>(std::malloc(kHeapReserve)); reserve != nullptr) {
    for (std::size_t i = 0; i < kHeapReserve; i += kPage) reserve[i] = 0;
    std::free(const_cast<unsigned char*>(reserve));
  }
  return refusals;
}

Refusals make_realtime(int core, int for_priority) {
  Refusals refusals;
  cpu_set_t only;
  CPU_ZERO(&only);
  CPU_SET(static_cast<std::size_t>(core), &only);
  if (const int e = pthread_setaffinity_np(pthread_self(), sizeof only, &only); e != 0) {
    refusals.push_back(refused("own core (affinity)", e, "allow the core to this process"));
  }
  sched_param priority{};
  priority.sched_priority = for_priority;
  if (const int e = pthread_setschedparam(pthread_self(), SCHED_FIFO, &priority); e != 0) {
    refusals.push_back(refused("SCHED_FIFO", e, "rtprio 80 in limits.conf, or CAP_SYS_NICE"));
  }
  if (prctl(PR_SET_TIMERSLACK, 1UL) != 0) refusals.push_back(refused("exact timers (timer slack)", errno, "none"));
  touch_stack();
  return refusals;
}

void flush_denormals() noexcept {
#if defined(__x86_64__)
  _mm_setcsr(_mm_getcsr() | 0x8040U);  // FTZ (results) and DAZ (operands)
#elif defined(__aarch64__)
  std::uint64_t fpcr = 0;
  asm volatile("mrs %0, fpcr" : "=r"(fpcr));
  asm volatile("msr fpcr, %0" ::"r"(fpcr | (std::uint64_t{1} << 24)));
#endif
}

bool stay_on(int core) noexcept {
  cpu_set_t only;
  CPU_ZERO(&only);
  CPU_SET(static_cast<std::size_t>(core), &only);
  return pthread_setaffinity_np(pthread_self(), sizeof only, &only) == 0;
}

/// A process does not start with isolated cores in its affinity mask, so an isolated core must be requested.
int realtime_core(const char* isolated) {
  std::string cores;
  std::getline(std::ifstream(isolated), cores);
  if (const int core = last_of(cores); core > 0) return core;
  cpu_set_t allowed;
  CPU_ZERO(&allowed);
  sched_getaffinity(0, sizeof allowed, &allowed);
  for (int core = CPU_SETSIZE - 1; core > 0; --core) {
    if (CPU_ISSET(static_cast<std::size_t>(core), &allowed)) return core;
  }
  return 0;
}

void keep_off(int core) noexcept {
  cpu_set_t allowed;
  CPU_ZERO(&allowed);
  sched_getaffinity(0, sizeof allowed, &allowed);
  if (CPU_COUNT(&allowed) < 2) return;
  CPU_CLR(static_cast<std::size_t>(core), &allowed);
  pthread_setaffinity_np(pthread_self(), sizeof allowed, &allowed);
}

}  // namespace ligature::platform
