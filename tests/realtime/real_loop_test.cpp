// The program's own two real-time threads (loop and thread physics), with their real buses, clock and wake-up,
// rendering force against two ligature-device processes: no page fault, no system call except for bus, clock and one
// wake-up, denormals flushed to zero. No time limits are checked.
#include <gtest/gtest.h>
#include <linux/audit.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <ucontext.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "firmware/app/real_time_side.hpp"
#include "ligature_source_dir.hpp"
#include "tests/realtime/watch.hpp"
#include "tests/support/temp_folder.hpp"

namespace ligature::app {
namespace {

using namespace std::chrono_literals;

constexpr int kFaulted = 10, kKept = 11, kAllocated = 12, kLocked = 13, kNoForce = 14,
              kNoRig = 15;  // exit codes of the confined process
constexpr int kWatchedTicks = 1000;

pid_t start_hand(const std::string& side, const std::string& folder) {
  const pid_t child = fork();
  if (child != 0) return child;
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  const std::string bus = "local:" + folder + side, source = LIGATURE_SOURCE_DIR;
  const std::string scene = source + "/scenes/paper.toml", script = source + "/scenes/operators/overhand.csv";
  execl(LIGATURE_DEVICE, "ligature-device", "--hand", side.c_str(), "--bus", bus.c_str(), "--scene", scene.c_str(),
        "--operator", script.c_str(), nullptr);
  _exit(127);
}

/// Installs a seccomp filter on all threads: a system call that bus, clock and wake-up do not need kills the process.
/// The wake-up needs futex, which locks use, too; locks are therefore counted separately (watch.hpp).
void confine() {
  constexpr std::array kAllowed{SYS_clock_gettime, SYS_clock_nanosleep, SYS_sendto,     SYS_sendmsg,
                                SYS_recvfrom,      SYS_recvmsg,         SYS_ppoll,      SYS_poll,
                                SYS_read,          SYS_write,           SYS_exit_group, SYS_futex};
  std::array<sock_filter, 2 * kAllowed.size() + 2> rules{};
  std::size_t n = 0;
  rules[n++] = BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, nr));
  for (const long call : kAllowed) {
    rules[n++] = BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, static_cast<unsigned>(call), 0, 1);
    rules[n++] = BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW);
  }
  rules[n++] = BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_KILL_PROCESS);
  const sock_fprog filter{static_cast<unsigned short>(n), rules.data()};
  prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0);
  if (syscall(SYS_seccomp, SECCOMP_SET_MODE_FILTER, SECCOMP_FILTER_FLAG_TSYNC, &filter) != 0) _exit(77);
}

std::vector<int> threads() {
  std::vector<int> ids;
  for (const auto& each : std::filesystem::directory_iterator("/proc/self/task"))
    ids.push_back(std::stoi(each.path().filename()));
  std::ranges::sort(ids);
  return ids;
}

/// Minor plus major page faults of one thread.
long page_faults_of(int thread) {
  std::stringstream stat;
  stat << std::ifstream("/proc/self/task/" + std::to_string(thread) + "/stat").rdbuf();
  std::istringstream rest(stat.str().substr(stat.str().rfind(')') + 1));
  std::string skipped;
  for (int field = 3; field < 10; ++field) rest >> skipped;
  long minor = 0, children = 0, major = 0;
  rest >> minor >> children >> major;
  return minor + major;
}

std::atomic<int> watched{0}, flushing{0};  // number of threads

/// Signal handler, run on a real-time thread. From now on the thread's allocations and mutex locks are counted
/// (watch.hpp). Also counts the threads whose floating-point flags treat denormal numbers as zero.
void begin_to_watch(int, siginfo_t*, void* context) {
  watch::watching = true;
#if defined(__x86_64__)
  const auto control = static_cast<ucontext_t*>(context)->uc_mcontext.fpregs->mxcsr;
#else
  (void)context;
  const unsigned control = 0x8040;
#endif
  flushing += (control & 0x8040) == 0x8040;
  ++watched;
}

/// The rig, built as by `ligature-firmware run`.
struct RealRig {
  explicit RealRig(const std::string& folder)
      : options(with(folder)), plan(std::get<Plan>(make_plan(options))), buses(open()) {}

  static RunOptions with(const std::string& folder) {
    RunOptions o;
    o.scene = std::string(LIGATURE_SOURCE_DIR) + "/scenes/paper.toml";
    o.left = "local:" + folder + "left", o.right = "local:" + folder + "right";
    // Initial credit, because lost periods are debited to a hand's energy account.
    o.overrides = {"hands.energy_credit_J=0.02"};
    o.arm = true;
    o.watchdog_ms = 2000;
    return o;
  }
  Buses open() const {
    auto opened = open_buses(options, plan.device, [] {
      std::this_thread::sleep_for(10ms);
      return false;
    });
    if (!std::holds_alternative<Buses>(opened)) _exit(kNoRig);
    return std::move(std::get<Buses>(opened));
  }
  void start() {
    const auto before = threads();
    (void)side.prepare(true, platform::realtime_core());
    std::vector<int> fresh;
    std::ranges::set_difference(threads(), before, std::back_inserter(fresh));
    std::ranges::copy_n(fresh.begin(), 2, contexts.begin());
    if (fresh.size() != 2) _exit(kNoRig);
    if (configure(buses)) _exit(kNoRig);
    for (const auto& drives : buses.drives) drives->start();
    side.start();
  }
  /// Reads `executed` tick records from the loop's ring. @return how many of them had force enabled.
  int follow(int executed) {
    int in_force = 0;
    for (rt::TickRecord r; executed > 0;) {
      if (!outlets->records.pop(r)) {
        std::this_thread::sleep_for(1ms);
        continue;
      }
      if ((r.flags & rt::kPeriodLost) != 0) continue;
      in_force += r.state == static_cast<int>(control::State::kForce);
      --executed;
    }
    return in_force;
  }

  RunOptions options;
  Plan plan;
  Buses buses;
  std::unique_ptr<rt::Outlets> outlets = std::make_unique<rt::Outlets>();
  control::PlantHandover plants;
  RealTimeSide side{options, plan, buses, *outlets, plants};
  [[nodiscard]] long page_faults() const { return page_faults_of(contexts[0]) + page_faults_of(contexts[1]); }
  std::array<int, 2> contexts{};  ///< thread ids: the loop, the thread's physics
};

/// @return an exit code; the process is killed on a forbidden system call.
int verdict(RealRig& rig) {
  rig.start();
  for (int tries = 0; rig.follow(100) < 100; ++tries) {
    if (tries > 100) return kNoForce;
  }
  struct sigaction reader {};
  reader.sa_sigaction = begin_to_watch;
  reader.sa_flags = SA_SIGINFO;
  sigaction(SIGUSR1, &reader, nullptr);
  for (const int thread : rig.contexts) syscall(SYS_tgkill, getpid(), thread, SIGUSR1);
  rig.follow(100);
  if (watched != 2 || flushing != 2) return kKept;

  const long before = rig.page_faults();
  if (rig.follow(kWatchedTicks) == 0) return kNoForce;
  if (rig.page_faults() != before) return kFaulted;
  if (watch::allocations != 0) return kAllocated;
  if (watch::locks != 0) return kLocked;

  confine();
  return rig.follow(kWatchedTicks) > 0 ? 0 : kNoForce;
}

/// Exits with the verdict while the loop still runs; shutdown is not tested here.
[[noreturn]] void watch(const std::string& folder) {
  RealRig rig(folder);
  _exit(verdict(rig));
}

/// @return as waitpid() has it, how the process with the rig ended.
int status_of_a_rig() {
  const std::string folder = test::temp_folder();
  const std::array hands{start_hand("left", folder), start_hand("right", folder)};
  const pid_t child = fork();
  if (child == 0) watch(folder);
  int status = 0;
  waitpid(child, &status, 0);
  for (const pid_t hand : hands) {
    kill(hand, SIGTERM);
    waitpid(hand, nullptr, 0);
  }
  return status;
}

/// On a busy machine samples come in bursts, and the rig ends its force (fault 18). So up to ten rigs try to keep it.
TEST(RealLoop, InForceItAsksTheKernelForBusClockAndTheOneWakeUpOnly) {
  int status = 0;
  for (int rigs = 0; rigs < 10; ++rigs) {
    status = status_of_a_rig();
    if (!WIFEXITED(status) || WEXITSTATUS(status) != kNoForce) break;
  }
  ASSERT_FALSE(WIFSIGNALED(status)) << "ended by signal " << WTERMSIG(status) << ", " << SIGSYS
                                    << " is a system call too many";
  EXPECT_NE(WEXITSTATUS(status), kFaulted) << "a page fault in the loop or in the thread's physics";
  EXPECT_NE(WEXITSTATUS(status), kAllocated) << "one of the two allocates";
  EXPECT_NE(WEXITSTATUS(status), kLocked) << "one of the two locks";
  EXPECT_NE(WEXITSTATUS(status), kKept) << "one of the two keeps denormals";
  EXPECT_NE(WEXITSTATUS(status), kNoForce) << "no force in " << kWatchedTicks << " ticks";
  EXPECT_EQ(WEXITSTATUS(status), 0);
}

}  // namespace
}  // namespace ligature::app
