// What can be asked of any machine: denormals vanish, refusals are sentences, cores are respected.
#include "firmware/platform/realtime.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sched.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>
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
  EXPECT_EQ(own_file_pages(), 0);
  EXPECT_EQ(pages_of_files(), 0);
}

/// Private writable memory of this process, bytes, as RLIMIT_DATA counts it.
rlim_t data_now() {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;) {
    rlim_t kB = 0;
    if (word == "VmData:" && status >> kB) return 1024 * kB;
  }
  return 0;
}

/// From here on this process has no right that a real-time thread asks for, whoever started it.
void give_up_rights() {
  constexpr uid_t kNobody = 65534;
  const rlimit none{0, 0}, hardly_any{data_now() + 65536, data_now() + 65536};  // no writable copy of any code
  bool gone = setrlimit(RLIMIT_RTPRIO, &none) == 0 && setrlimit(RLIMIT_MEMLOCK, &none) == 0 &&
              setrlimit(RLIMIT_DATA, &hardly_any) == 0;
  if (geteuid() == 0)
    gone = gone && setresgid(kNobody, kNobody, kNobody) == 0 && setresuid(kNobody, kNobody, kNobody) == 0;
  if (!gone) _exit(EXIT_FAILURE);
}

/// What a process without rights is told, line by line.
Refusals refusals_without_rights() {
  constexpr int kNoCore = CPU_SETSIZE - 1;
  int ends[2];
  if (pipe(ends) != 0) return {};
  if (const pid_t child = fork(); child != 0) {
    close(ends[1]);
    std::string text;
    for (char c; read(ends[0], &c, 1) == 1;) text += c;
    close(ends[0]);
    int status = 0;
    EXPECT_EQ(waitpid(child, &status, 0), child);
    EXPECT_EQ(status, 0);
    Refusals lines;
    std::istringstream stream(text);
    for (std::string line; std::getline(stream, line);) lines.push_back(line);
    return lines;
  }
  give_up_rights();
  std::string text;
  for (const auto& refusals : {lock_memory(), make_realtime(kNoCore)})
    for (const auto& r : refusals) text += r + '\n';
  const bool told = write(ends[1], text.data(), text.size()) == static_cast<ssize_t>(text.size());
  _exit(told ? EXIT_SUCCESS : EXIT_FAILURE);
}

TEST(Realtime, EveryRefusalNamesItsCauseAndItsRemedy) {
  const Refusals refusals = refusals_without_rights();
  for (const std::string what :
       {"locked memory (mlockall)", "copies of code and constants (madvise)", "own core (affinity)", "SCHED_FIFO"}) {
    const auto is_it = [&](const auto& r) { return r.starts_with(what + " refused ("); };
    EXPECT_TRUE(std::ranges::any_of(refusals, is_it)) << what;
  }
  for (const auto& r : refusals) {
    const std::string word = "; remedy: ";
    const auto remedy = r.find(word);
    ASSERT_NE(remedy, std::string::npos) << r;
    EXPECT_GT(r.size(), remedy + word.size()) << r;
  }
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
