// What can be asked of any machine: denormals vanish, refusals are sentences, cores are respected.
#include "firmware/platform/realtime.hpp"

#include <gtest/gtest.h>
#include <sched.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <limits>
#include <thread>

#include "firmware/platform/idle_guard.hpp"
#include "tests/support/temp_folder.hpp"

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

TEST(IdleGuard, AsksForZeroMicrosecondsAndHoldsTheRequest) {
  const std::string device = test::temp_folder() + "cpu_dma_latency";
  std::ofstream(device) << "";
  const IdleGuard guard(device.c_str());
  EXPECT_EQ(guard.refusal(), "");
  EXPECT_EQ(std::filesystem::file_size(device), sizeof(std::int32_t));
}

TEST(IdleGuard, SaysWhyNotAndWhatHelps) {
  const IdleGuard guard("/nowhere/cpu_dma_latency");
  EXPECT_NE(guard.refusal().find("No such file"), std::string::npos);
  EXPECT_NE(guard.refusal().find("remedy"), std::string::npos);
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
