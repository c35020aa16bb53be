#include "firmware/app/doctor/can_echo.hpp"

#include <fcntl.h>
#include <linux/can.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <vector>

#include "firmware/app/cold_clock.hpp"
#include "firmware/platform/monotonic_clock.hpp"

namespace ligature::app {
namespace {

constexpr canid_t kProbe = 0x7C1;
constexpr auto kSpacing = std::chrono::milliseconds(2);
constexpr int kPatience_ms = 10;

/// Opens a socket that receives the frames that it has sent itself with identifier kProbe, and no others. @return -1
/// with errno.
int open_probe(const std::string& interface) {
  const int fd = socket(PF_CAN, SOCK_RAW | SOCK_CLOEXEC | SOCK_NONBLOCK, CAN_RAW);
  if (fd < 0) return -1;
  const int on = 1;
  const can_filter only{kProbe, CAN_SFF_MASK | CAN_EFF_FLAG | CAN_RTR_FLAG};
  sockaddr_can address{};
  address.can_family = AF_CAN;
  address.can_ifindex = static_cast<int>(if_nametoindex(interface.c_str()));
  if (address.can_ifindex == 0 || setsockopt(fd, SOL_CAN_RAW, CAN_RAW_RECV_OWN_MSGS, &on, sizeof on) != 0 ||
      setsockopt(fd, SOL_CAN_RAW, CAN_RAW_FILTER, &only, sizeof only) != 0 ||
      bind(fd, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
    const int why = errno;
    close(fd);
    errno = why;
    return -1;
  }
  return fd;
}

/// Waits for the frame to come back. @return whether it did in time.
bool await(int fd) {
  pollfd waiting{fd, POLLIN, 0};
  can_frame frame{};
  return poll(&waiting, 1, kPatience_ms) > 0 && read(fd, &frame, sizeof frame) == sizeof frame;
}

double median(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

}  // namespace

double local_exchange_us() {
  constexpr int kTimes = 500;
  std::array<int, 2> ends{};
  if (socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_NONBLOCK | SOCK_CLOEXEC, 0, ends.data()) != 0) return 0.0;
  std::vector<double> calls_us;
  const can_frame probe{};
  for (int i = 0; i < kTimes; ++i) {
    const double before_us = cpu_us();
    if (write(ends[0], &probe, sizeof probe) == sizeof probe && await(ends[1]))
      calls_us.push_back(cpu_us() - before_us);
  }
  for (const int fd : ends) close(fd);
  return calls_us.empty() ? 0.0 : median(calls_us);
}

CanEcho measure_echo(const std::string& interface, double seconds) {
  CanEcho echo;
  echo.interface = interface;
  const int fd = open_probe(interface);
  if (fd < 0) {
    echo.problem = std::strerror(errno);
    return echo;
  }
  platform::MonotonicClock clock;
  std::vector<double> calls_us;
  can_frame probe{};
  probe.can_id = kProbe;
  auto due = clock.now();
  const auto end = due + std::chrono::nanoseconds(static_cast<std::int64_t>(seconds * 1e9));
  for (; due < end; due = std::max(due + kSpacing, clock.now())) {
    clock.sleep_until(due);
    const auto sent = clock.now();
    const double before_us = cpu_us();
    if (write(fd, &probe, sizeof probe) != sizeof probe) {
      echo.problem = std::strerror(errno);
      break;
    }
    if (await(fd)) {
      echo.round_trips.add((clock.now() - sent).count());
      calls_us.push_back(cpu_us() - before_us);
    } else {
      ++echo.lost;
    }
  }
  close(fd);
  if (!calls_us.empty()) echo.calls_us = median(calls_us);
  return echo;
}

}  // namespace ligature::app
