// What can be asked of any machine: denormals vanish, refusals are sentences, cores are respected.
#include "firmware/platform/realtime.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sched.h>
#include <unistd.h>

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>
#include <thread>

#include "firmware/platform/idle_guard.hpp"
#include "firmware/platform/own_pages.hpp"
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

/// Pages that are present and still the file's (bit 61 of pagemap), of mappings that are not shared with others.
int pages_of_files() {
  std::ifstream maps("/proc/self/maps");
  const int pagemap = open("/proc/self/pagemap", O_RDONLY);
  int found = 0;
  for (std::string line; std::getline(maps, line);) {
    unsigned long from = 0, to = 0, inode = 0;
    char may[5] = "";
    std::sscanf(line.c_str(), "%lx-%lx %4s %*s %*s %lu", &from, &to, may, &inode);
    for (auto page = from / 4096; inode != 0 && may[0] == 'r' && may[3] == 'p' && page < to / 4096; ++page) {
      std::uint64_t entry = 0;
      if (pread(pagemap, &entry, sizeof entry, static_cast<off_t>(page * 8)) != sizeof entry) break;
      found += (entry >> 63 & 1) != 0 && (entry >> 61 & 1) != 0;
    }
  }
  close(pagemap);
  return found;
}

/// What the page cache holds may be taken away, locked or not.
TEST(Realtime, CodeAndConstantsAreCopiesOfTheirFiles) {
  ASSERT_GT(pages_of_files(), 0) << "the guard must see them";
  EXPECT_EQ(own_file_pages(), 0U);
  EXPECT_EQ(pages_of_files(), 0);
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
