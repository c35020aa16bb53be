// What can be asked of any machine: denormals vanish, refusals are sentences, cores are respected.
#include "firmware/platform/realtime.hpp"

#include <gtest/gtest.h>
#include <sched.h>

#include <limits>
#include <thread>

namespace ligature::platform {
namespace {

TEST(Realtime, FlushesDenormals) {
#if defined(__x86_64__) || defined(__aarch64__)
  std::thread([] {  // the mode belongs to a thread
    flush_denormals();
    volatile double small = std::numeric_limits<double>::min();
    volatile double half = small / 2.0;
    EXPECT_EQ(half, 0.0);
  })
      .join();
#endif
}

TEST(Realtime, EveryRefusalNamesItsRemedy) {
  std::thread([] {
    for (const auto& r : make_realtime(realtime_core())) EXPECT_NE(r.find("remedy"), std::string::npos) << r;
  }).join();
}

TEST(Realtime, OthersKeepOffTheRealTimeCore) {
  std::thread([] {
    const int core = realtime_core();
    keep_off(core);
    cpu_set_t allowed;
    CPU_ZERO(&allowed);
    ASSERT_EQ(sched_getaffinity(0, sizeof allowed, &allowed), 0);
    EXPECT_TRUE(CPU_COUNT(&allowed) == 1 || !CPU_ISSET(static_cast<std::size_t>(core), &allowed));
  }).join();
}

}  // namespace
}  // namespace ligature::platform
