// Real-time set-up that works on any machine: denormals are flushed, refusals are reported, and core lists are obeyed.
#include "firmware/platform/realtime.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/prctl.h>
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
#include <vector>

#include "firmware/platform/idle_guard.hpp"
#include "firmware/platform/own_pages.hpp"
#include "firmware/platform/sanitized.hpp"
#include "tests/support/temp_folder.hpp"

namespace ligature::platform {
namespace {

TEST(Realtime, FlushesDenormals) {
#if defined(__x86_64__) || defined(__aarch64__)
  std::thread([] {  // the mode is per thread
    flush_denormals();
    volatile double small = std::numeric_limits<double>::min();
    volatile double half = small / 2.0;
    EXPECT_EQ(half, 0.0);
  })
      .join();
#endif
}

/// Number of resident pages that still belong to a file (bit 61 of pagemap), in private mappings.
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

/// File pages may be evicted even if they are locked, so they must be replaced by private copies.
TEST(Realtime, CodeAndConstantsAreCopiesOfTheirFiles) {
  ASSERT_GT(pages_of_files(), 0) << "the guard must see them";
  EXPECT_EQ(own_file_pages(), 0);
  EXPECT_EQ(pages_of_files(), 0);
}

#ifdef LIGATURE_SANITIZED
constexpr bool kDataIsLimited = false;  // a sanitizer's allocator ends the process when it cannot grow
#else
constexpr bool kDataIsLimited = true;
#endif

/// Private writable memory of this process in bytes, as RLIMIT_DATA counts it.
rlim_t data_now() {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;) {
    rlim_t kB = 0;
    if (word == "VmData:" && status >> kB) return 1024 * kB;
  }
  return 0;
}

/// Removes all rights that a real-time thread needs from this process, also when started by root.
void give_up_rights() {
  constexpr uid_t kNobody = 65534;
  const rlimit none{0, 0};
  bool gone = setrlimit(RLIMIT_RTPRIO, &none) == 0 && setrlimit(RLIMIT_MEMLOCK, &none) == 0;
  if (kDataIsLimited) {
    const rlim_t most = data_now() + 65536;  // too little for writable copies of the code
    const rlimit hardly_any{most,
                            most};  // asked once: a second call may find less, and a soft limit above the hard one
    gone = gone && setrlimit(RLIMIT_DATA, &hardly_any) == 0;
  }
  if (geteuid() == 0)
    gone = gone && setresgid(kNobody, kNobody, kNobody) == 0 && setresuid(kNobody, kNobody, kNobody) == 0;
  if (!gone) _exit(EXIT_FAILURE);
}

/// The refusals that a process without rights gets, one per line.
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
  std::string text(100'000, ' ');  // the heap cannot grow later, so memory for the messages is reserved here
  text = std::string();
  give_up_rights();
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
    const bool is_expected = kDataIsLimited || !what.starts_with("copies");
    EXPECT_EQ(std::ranges::any_of(refusals, is_it), is_expected) << what;
  }
  for (const auto& r : refusals) {
    const std::string word = "; remedy: ";
    const auto remedy = r.find(word);
    ASSERT_NE(remedy, std::string::npos) << r;
    EXPECT_GT(r.size(), remedy + word.size()) << r;
  }
}

/// Number of open descriptors of this process for a file.
int times_open(const std::string& file) {
  int times = 0;
  std::error_code gone;  // the descriptor of the folder itself
  for (const auto& fd : std::filesystem::directory_iterator("/proc/self/fd"))
    times += std::filesystem::read_symlink(fd.path(), gone) == file;
  return times;
}

/// The kernel keeps the latency request while the file is open.
TEST(IdleGuard, AsksForZeroMicrosecondsAndHoldsTheRequest) {
  const std::string device = std::filesystem::canonical(test::temp_folder()) / "cpu_dma_latency";
  std::ofstream(device) << "";
  {
    const IdleGuard guard(device.c_str());
    EXPECT_EQ(guard.refusal(), "");
    std::int32_t asked_us = -1;
    ASSERT_EQ(std::filesystem::file_size(device), sizeof asked_us);
    std::ifstream(device).read(reinterpret_cast<char*>(&asked_us), sizeof asked_us);
    EXPECT_EQ(asked_us, 0);
    EXPECT_EQ(times_open(device), 1) << "closed, the request is over";
  }
  EXPECT_EQ(times_open(device), 0);
}

/// A new thread that requests real-time rights, on a stack that has not been used before; stores the settings that the
/// kernel then reports.
struct OwnThread {
  static constexpr std::size_t kStack = std::size_t{1} << 20, kPage = 4096;
  Refusals refusals;
  int policy = -1, core = -1, cores = 0;
  sched_param priority{};
  int slack_ns = -1;
  std::size_t stack_pages = 0;  // resident
  void* stack = nullptr;

  static void* begin(void* self) {
    auto& t = *static_cast<OwnThread*>(self);
    t.refusals = make_realtime(t.core);
    pthread_getschedparam(pthread_self(), &t.policy, &t.priority);
    t.slack_ns = prctl(PR_GET_TIMERSLACK);
    cpu_set_t allowed;
    CPU_ZERO(&allowed);
    sched_getaffinity(0, sizeof allowed, &allowed);
    t.cores = CPU_COUNT(&allowed);
    if (!CPU_ISSET(static_cast<std::size_t>(t.core), &allowed)) t.cores = -1;
    return nullptr;
  }
  void run() {
    core = realtime_core();
    stack = mmap(nullptr, kStack, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    ASSERT_NE(stack, MAP_FAILED);
    pthread_attr_t attributes;
    pthread_attr_init(&attributes);
    pthread_attr_setstack(&attributes, stack, kStack);
    pthread_t thread;
    ASSERT_EQ(pthread_create(&thread, &attributes, begin, this), 0);
    pthread_join(thread, nullptr);
    pthread_attr_destroy(&attributes);
    std::vector<unsigned char> present(kStack / kPage);
    ASSERT_EQ(mincore(stack, kStack, present.data()), 0);
    stack_pages = static_cast<std::size_t>(std::ranges::count_if(present, [](auto p) { return (p & 1) != 0; }));
    munmap(stack, kStack);
  }
};

/// Each setting must either be confirmed by the kernel or be reported as refused.
TEST(Realtime, AThreadHasTheCoreThePriorityTheTimersAndTheStackThatItAskedFor) {
  OwnThread t;
  t.run();
  const auto refused = [&](const char* what) {
    return std::ranges::any_of(t.refusals, [&](const auto& r) { return r.starts_with(what); });
  };
  if (refused("SCHED_FIFO")) {
    EXPECT_EQ(t.policy, SCHED_OTHER);
  } else {
    EXPECT_EQ(t.policy, SCHED_FIFO);
    EXPECT_EQ(t.priority.sched_priority, 80) << "above threaded interrupts, which have 50";
  }
  EXPECT_EQ(t.cores, refused("own core") ? t.cores : 1);
  EXPECT_FALSE(refused("exact timers"));
  EXPECT_LE(t.slack_ns, 1) << "50 us is what a thread begins with; for real-time ones newer kernels say 0";
  EXPECT_GE(t.stack_pages * OwnThread::kPage, 256U * 1024U) << "the loop's first deep call would fault";
}

/// For real-time threads newer kernels report a timer slack of 0 in any case; a thread without real-time priority must
/// set it.
TEST(Realtime, TimersAreExactWithoutAPriority) {
  const pid_t child = fork();
  if (child == 0) {
    give_up_rights();
    (void)make_realtime(realtime_core());
    _exit(sched_getscheduler(0) != SCHED_OTHER ? 2 : prctl(PR_GET_TIMERSLACK) == 1 ? 0 : 1);
  }
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 0) << "1: a timer may be 50 us late, 2: the priority was not refused";
}

#ifndef LIGATURE_SANITIZED  // sanitizers bring their own allocator
/// In a child process, because the setting cannot be undone.
TEST(Realtime, TheHeapKeepsWhatItHas) {
  const pid_t child = fork();
  if (child == 0) {
    const rlimit small{0, 0};
    setrlimit(RLIMIT_MEMLOCK, &small);
    (void)lock_memory();
    constexpr std::size_t kBlock = 65536, kBlocks = 256, kLarge = std::size_t{4} << 20;
    std::vector<void*> blocks;
    for (std::size_t i = 0; i < kBlocks; ++i) blocks.push_back(std::malloc(kBlock));
    void* const large = std::malloc(kLarge);
    const auto end = reinterpret_cast<std::uintptr_t>(sbrk(0)), at = reinterpret_cast<std::uintptr_t>(large);
    const bool in_heap = at < end && at + kLarge <= end;
    std::free(large);
    for (void* block : blocks) std::free(block);
    const bool kept = reinterpret_cast<std::uintptr_t>(sbrk(0)) == end;
    _exit(!in_heap ? 2 : kept ? 0 : 1);
  }
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 0) << "1: freed memory went back to the system, 2: a large block is not of the heap";
}
#endif

TEST(IdleGuard, SaysWhyNotAndWhatHelps) {
  const IdleGuard guard("/nowhere/cpu_dma_latency");
  EXPECT_NE(guard.refusal().find("No such file"), std::string::npos);
  EXPECT_NE(guard.refusal().find("remedy"), std::string::npos);
}

TEST(Realtime, TheCoreIsTheLastIsolatedOneOrTheLastThatThereIs) {
  const std::string file = test::temp_folder() + "isolated";
  const auto core_of = [&](const char* list) {
    std::ofstream(file) << list << "\n";
    return realtime_core(file.c_str());
  };
  EXPECT_EQ(core_of("3"), 3);
  EXPECT_EQ(core_of("2-5"), 5);
  EXPECT_EQ(core_of("1,13"), 13);
  EXPECT_EQ(core_of("1,3-5,7-11"), 11);
  cpu_set_t allowed;
  CPU_ZERO(&allowed);
  ASSERT_EQ(sched_getaffinity(0, sizeof allowed, &allowed), 0);
  const int core = core_of("");
  EXPECT_EQ(realtime_core("/nowhere/isolated"), core);
  for (int later = core + 1; later < CPU_SETSIZE; ++later)
    EXPECT_FALSE(CPU_ISSET(static_cast<std::size_t>(later), &allowed)) << later;
}

TEST(Realtime, OthersKeepOffTheRealTimeCore) {
  std::thread([] {
    const int core = realtime_core();
    cpu_set_t allowed;
    CPU_ZERO(&allowed);
    ASSERT_EQ(sched_getaffinity(0, sizeof allowed, &allowed), 0);
    const int before = CPU_COUNT(&allowed);
    const int away = before > 1 && CPU_ISSET(static_cast<std::size_t>(core), &allowed) ? 1 : 0;
    keep_off(core);
    CPU_ZERO(&allowed);
    ASSERT_EQ(sched_getaffinity(0, sizeof allowed, &allowed), 0);
    EXPECT_TRUE(before == 1 || !CPU_ISSET(static_cast<std::size_t>(core), &allowed));
    EXPECT_EQ(CPU_COUNT(&allowed), before - away) << "and on every other one";
  }).join();
}

}  // namespace
}  // namespace ligature::platform
