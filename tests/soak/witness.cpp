// A witness of the machine: does the same work every millisecond and tells how much CPU time the kernel charged for it.
//   soak_witness SECONDS WORK_US LIMIT_US
// In a virtual machine the kernel also charges a thread for time that the hypervisor or an interrupt took. The soak
// test cannot tell such time from the loop's own work. The work of this program never changes, so any additional CPU
// time is due to the machine. The program runs on the loop's core with a lower real-time priority than the rig.

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "firmware/platform/monotonic_clock.hpp"
#include "firmware/platform/realtime.hpp"

namespace {

using ligature::platform::MonotonicClock, ligature::platform::Nanoseconds;

/// CPU time that the kernel has charged to this thread, us.
double charged_us() { return 1e-3 * static_cast<double>(MonotonicClock{}.worked().count()); }

/// A chain of multiplications that no compiler can shorten.
std::uint32_t work(long steps) {
  std::uint32_t x = 1;
  for (long i = 0; i < steps; ++i) {
    x = x * 1664525u + 1013904223u;
    asm volatile("" : "+r"(x));
  }
  return x;
}

/// Number of steps that take `us` of CPU time when nothing disturbs them: the least of many tries.
long steps_for(double us) {
  constexpr long kTried = 20'000;
  double least_us = 1e12;
  for (int i = 0; i < 200; ++i) {
    const double before = charged_us();
    (void)work(kTried);
    least_us = std::min(least_us, charged_us() - before);
  }
  return static_cast<long>(us / least_us * static_cast<double>(kTried));
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4) {
    std::fprintf(stderr,
                 "usage: soak_witness SECONDS WORK_US LIMIT_US (work: 1 .. 100 us, so that it cannot starve a core)\n");
    return 2;
  }
  const double seconds = std::atof(argv[1]), work_us = std::atof(argv[2]), limit_us = std::atof(argv[3]);
  if (seconds <= 0.0 || work_us < 1.0 || work_us > 100.0 || limit_us <= work_us) return 2;
  constexpr int kBelowTheRig = 60;
  for (const auto& refusal : ligature::platform::make_realtime(ligature::platform::realtime_core(), kBelowTheRig))
    std::fprintf(stderr, "soak_witness: %s\n", refusal.c_str());
  const long steps = steps_for(work_us);
  std::vector<double> took_us;
  const auto periods = static_cast<std::size_t>(1e3 * seconds);
  took_us.reserve(periods);
  MonotonicClock clock;
  for (Nanoseconds next = clock.now(); took_us.size() < periods;) {
    clock.sleep_until(next += std::chrono::milliseconds(1));
    const double before = charged_us();
    (void)work(steps);
    took_us.push_back(charged_us() - before);
  }
  const auto over = std::ranges::count_if(took_us, [&](double t) { return t > limit_us; });
  std::ranges::sort(took_us);
  // periods, least, median, worst, number above the limit
  std::printf("%zu %.1f %.1f %.1f %td\n", took_us.size(), took_us.front(), took_us[took_us.size() / 2], took_us.back(),
              over);
}
