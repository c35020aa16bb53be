#include "firmware/app/doctor/load.hpp"

#include <fcntl.h>
#include <net/if.h>
#include <netinet/in.h>
#include <sched.h>
#include <signal.h>
#include <sys/ioctl.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstring>
#include <vector>

namespace ligature::app {
namespace {

using Clock = std::chrono::steady_clock;
constexpr std::size_t kMemory = 64U << 20U, kFile = 32U << 20U, kBlock = 1U << 20U;

void copy_memory(Clock::time_point end) {
  std::vector<char> memory(kMemory, 1);
  for (std::size_t at = 0; Clock::now() < end; at = (at + kBlock) % (kMemory / 2))
    std::memcpy(memory.data() + at, memory.data() + kMemory / 2 + at, kBlock);
}

void compute(Clock::time_point end) {
  volatile double sum = 0.0;
  while (Clock::now() < end)
    for (int i = 1; i < 20'000; ++i) sum = sum + std::sqrt(static_cast<double>(i));
}

void write_disk(Clock::time_point end) {
  const int file = open("/var/tmp", O_TMPFILE | O_WRONLY | O_CLOEXEC, 0600);
  const std::vector<char> block(kBlock, 'x');
  for (std::size_t at = 0; file >= 0 && Clock::now() < end; at = (at + kBlock) % kFile)
    if (pwrite(file, block.data(), block.size(), static_cast<off_t>(at)) < 0 || fdatasync(file) != 0) return;
}

/// Opens a UDP socket that is connected to itself, on the loopback interface of a new network namespace. @return -1
/// when the kernel does not allow it.
int lonely_socket() {
  if (unshare(CLONE_NEWNET) != 0 && unshare(CLONE_NEWUSER | CLONE_NEWNET) != 0) return -1;
  const int fd = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (fd < 0) return -1;
  ifreq loopback{};
  std::strcpy(loopback.ifr_name, "lo");
  loopback.ifr_flags = IFF_UP;
  sockaddr_in here{};
  here.sin_family = AF_INET;
  here.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof here;
  auto* const address = reinterpret_cast<sockaddr*>(&here);
  if (ioctl(fd, SIOCSIFFLAGS, &loopback) != 0 || bind(fd, address, size) != 0 || getsockname(fd, address, &size) != 0 ||
      connect(fd, address, size) != 0)
    return -1;
  return fd;
}

void send_packets(Clock::time_point end) {
  const int fd = lonely_socket();
  std::array<char, 8192> packet{};
  while (fd >= 0 && Clock::now() < end) {
    if (send(fd, packet.data(), packet.size(), MSG_DONTWAIT) < 0 && errno != EAGAIN) return;
    (void)recv(fd, packet.data(), packet.size(), MSG_DONTWAIT);
  }
}

/// Runs one load process. It first resets the signal and scheduling settings that it inherits, because the load must
/// not have real-time priority.
[[noreturn]] void live(void (*work)(Clock::time_point), double seconds, pid_t parent) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(0);  // the parent has ended already
  signal(SIGINT, SIG_DFL);
  signal(SIGTERM, SIG_DFL);
  const sched_param normal{};
  sched_setscheduler(0, SCHED_OTHER, &normal);
  alarm(static_cast<unsigned>(seconds) + 10);  // ends it even if the work hangs
  work(Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds)));
  _exit(0);
}

}  // namespace

Load::Load(double seconds) {
  struct Kind {
    const char* name;
    void (*work)(Clock::time_point);
  };
  const pid_t parent = getpid();
  for (const auto& [name, work] :
       {Kind{"memory", copy_memory}, Kind{"cpu", compute}, Kind{"disk", write_disk}, Kind{"network", send_packets}}) {
    const pid_t child = fork();
    if (child == 0) live(work, seconds, parent);
    if (child > 0) processes_.push_back(child);
    kinds_.push_back(child > 0 ? name : std::string(name) + ": refused, " + std::strerror(errno));
  }
}

int Load::running() {
  std::erase_if(processes_, [](pid_t child) { return waitpid(child, nullptr, WNOHANG) == child; });
  return static_cast<int>(processes_.size());
}

Load::~Load() {
  for (const pid_t child : processes_) kill(child, SIGKILL);
  for (const pid_t child : processes_) waitpid(child, nullptr, 0);
}

}  // namespace ligature::app
