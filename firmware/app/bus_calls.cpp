#include "firmware/app/bus_calls.hpp"

#include <sys/socket.h>

#include <algorithm>
#include <array>

#include "firmware/app/cold_clock.hpp"
#include "firmware/platform/socket_bus.hpp"

namespace ligature::app {
namespace {

constexpr int kTicks = 20;
constexpr int kRepeats = 3;
constexpr int kHands = 2, kNodes = 3;

void drain(platform::CanBus& bus) noexcept {
  for (can::Frame frame; bus.receive(frame) == platform::Receive::kFrame;) {
  }
}

/// All kernel calls of one tick for one hand: send SYNC, read the TPDOs, send the RPDOs.
void call(platform::CanBus& bus) noexcept {
  bus.send({.id = 0x080});
  drain(bus);
  for (int node = 0; node < kNodes; ++node) bus.send({.id = 0x201, .dlc = 4});
}

}  // namespace

double bus_calls_us() {
  std::array<int, 2> ends{};
  if (socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_NONBLOCK | SOCK_CLOEXEC, 0, ends.data()) != 0) return 0.0;
  platform::SocketBus ours(ends[0]), theirs(ends[1]);
  ColdCaches cold;
  double worst_us = 0.0;
  for (int tick = 0; tick < kTicks; ++tick) {
    double least_us = 1e12;
    for (int repeat = 0; repeat < kRepeats; ++repeat) {
      double us = 0.0;
      for (int hand = 0; hand < kHands; ++hand) {
        for (int node = 0; node < kNodes; ++node) theirs.send({.id = 0x181, .dlc = 8});
        if (hand == 0) cold();
        const double before = cpu_us();
        call(ours);
        us += cpu_us() - before;
        drain(theirs);
      }
      least_us = std::min(least_us, us);
    }
    worst_us = std::max(worst_us, least_us);
  }
  return worst_us;
}

}  // namespace ligature::app
