// A serial CAN adapter (Lawicel ASCII lines) between the guest's slcan driver and a CAN interface that serves as the
// wire. Unlike the emulated SJA1000 it has error counters: on a signal it goes bus-off and reports it, and the driver
// then reacts as every CAN driver does. Runs in the guest of scripts/test-hil, as root.
//   slcan-adapter INTERFACE    prints the name of the driver's interface; SIGUSR1: bus-off, SIGUSR2: recover
#include <fcntl.h>
#include <linux/can.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/signalfd.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <charconv>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>

namespace {

constexpr int kSlcanLine = 17;  // N_SLCAN of linux/tty.h, a header that cannot be included together with C++ ones
// Receive and transmit error counters, three digits each; a transmitter is bus-off from 256 on (ISO 11898-1).
constexpr std::string_view kBusOff = "sb000256\r", kErrorActive = "sa000000\r";

[[noreturn]] void fail(const char* what) {
  std::perror(what);
  std::exit(1);
}

/// Format: 't', three hex digits of identifier, length, two hex digits per byte.
std::string to_line(const can_frame& frame) {
  char text[8 + 2 * CAN_MAX_DLEN];
  int n = std::snprintf(text, sizeof text, "t%03X%d", frame.can_id & CAN_SFF_MASK, frame.can_dlc);
  for (int i = 0; i < frame.can_dlc; ++i)
    n += std::snprintf(text + n, sizeof text - static_cast<std::size_t>(n), "%02X", frame.data[i]);
  return std::string(text, static_cast<std::size_t>(n)) + '\r';
}

template <class Number>
bool hex(std::string_view line, std::size_t at, std::size_t digits, Number& value) {
  if (line.size() < at + digits) return false;
  const char *begin = line.data() + at, *end = begin + digits;
  return std::from_chars(begin, end, value, 16).ptr == end;
}

bool to_frame(std::string_view line, can_frame& frame) {
  frame = {};
  if (line.empty() || line[0] != 't' || !hex(line, 1, 3, frame.can_id) || !hex(line, 4, 1, frame.can_dlc)) return false;
  if (frame.can_dlc > CAN_MAX_DLEN) return false;
  for (std::size_t i = 0; i < frame.can_dlc; ++i)
    if (!hex(line, 5 + 2 * i, 2, frame.data[i])) return false;
  return true;
}

int can_socket(const char* interface) {
  const int fd = socket(PF_CAN, SOCK_RAW | SOCK_NONBLOCK, CAN_RAW);
  sockaddr_can address{};
  address.can_family = AF_CAN;
  address.can_ifindex = static_cast<int>(if_nametoindex(interface));
  if (fd < 0 || bind(fd, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) fail(interface);
  return fd;
}

class Adapter {
 public:
  explicit Adapter(const char* wire) : wire_(can_socket(wire)), serial_(posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK)) {
    if (serial_ < 0 || grantpt(serial_) != 0 || unlockpt(serial_) != 0) fail("pty");
    const int driver = open(ptsname(serial_), O_RDWR | O_NOCTTY);  // kept open: closing it removes the interface
    ifreq name{};
    if (driver < 0 || ioctl(driver, TIOCSETD, &kSlcanLine) != 0 || ioctl(driver, SIOCGIFNAME, name.ifr_name) != 0)
      fail("slcan");
    std::puts(name.ifr_name);
    std::fflush(stdout);
  }

  void run(int signals) {
    std::array<pollfd, 3> fds{{{serial_, POLLIN, 0}, {wire_, POLLIN, 0}, {signals, POLLIN, 0}}};
    for (;;) {
      if (poll(fds.data(), fds.size(), -1) < 0) fail("poll");
      if (fds[2].revents != 0 && !obey(signals)) return;
      from_driver();
      from_wire();
    }
  }

 private:
  bool obey(int signals) {
    signalfd_siginfo told;
    if (read(signals, &told, sizeof told) != sizeof told || told.ssi_signo == SIGTERM) return false;
    is_off_ = told.ssi_signo == SIGUSR1;
    tell(is_off_ ? kBusOff : kErrorActive);
    return true;
  }

  void tell(std::string_view line) {
    if (write(serial_, line.data(), line.size()) != static_cast<ssize_t>(line.size())) fail("write to the driver");
  }

  void from_driver() {
    char some[512];
    for (ssize_t n; (n = read(serial_, some, sizeof some)) > 0;) {
      for (const char c : std::string_view(some, static_cast<std::size_t>(n))) {
        if (c != '\r') {
          line_ += c;
          continue;
        }
        heard();
        line_.clear();
      }
    }
  }

  void heard() {
    can_frame frame;
    if (line_ == "O") is_off_ = false;  // the driver reopens the interface, which resets the controller
    if (is_off_ || !to_frame(line_, frame)) return;
    if (write(wire_, &frame, sizeof frame) != sizeof frame) std::perror("write to the wire");
  }

  void from_wire() {
    can_frame frame;
    while (read(wire_, &frame, sizeof frame) == sizeof frame)
      if (!is_off_) tell(to_line(frame));
  }

  int wire_, serial_;
  bool is_off_ = false;
  std::string line_;
};

}  // namespace

int main(int count, char** arguments) {
  if (count != 2) {
    std::fputs("usage: slcan-adapter INTERFACE\n", stderr);
    return 2;
  }
  sigset_t told;
  sigemptyset(&told);
  for (const int signal : {SIGUSR1, SIGUSR2, SIGTERM}) sigaddset(&told, signal);
  sigprocmask(SIG_BLOCK, &told, nullptr);
  Adapter(arguments[1]).run(signalfd(-1, &told, 0));
  return 0;
}
