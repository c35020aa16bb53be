#include "firmware/app/bus_calls.hpp"

#include <sys/socket.h>

#include <algorithm>
#include <array>

#include "firmware/app/cold_clock.hpp"
#include "firmware/platform/make_drives.hpp"
#include "firmware/platform/socket_bus.hpp"

namespace ligature::app {
namespace {

constexpr int kTicks = 20;
constexpr int kRepeats = 3;

/// @return the number of frames
int drain(platform::CanBus& bus) noexcept {
  int frames = 0;
  for (can::Frame frame; bus.receive(frame) == platform::Receive::kFrame;) ++frames;
  return frames;
}

/// All that a tick does for one hand.
void exchange(platform::HandDrives& drives) noexcept {
  drives.request();
  drives.drain();
  (void)drives.reading();
  drives.write({});
}

}  // namespace

double bus_calls_us(const device::Device& device) {
  std::array<int, 2> ends{};
  if (socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_NONBLOCK | SOCK_CLOEXEC, 0, ends.data()) != 0) return 0.0;
  platform::SocketBus ours(ends[0]), theirs(ends[1]);
  const auto drives = platform::make_drives(ours, device, 20, 0);
  const auto samples = drives->example_samples();
  ColdCaches cold;
  double worst_us = 0.0;
  for (int tick = 0; tick < kTicks; ++tick) {
    double least_us = 1e12;
    for (int repeat = 0; repeat < kRepeats; ++repeat) {
      double us = 0.0;
      for (std::size_t hand = 0; hand < rt::kHands; ++hand) {
        for (const can::Frame& sample : samples) theirs.send(sample);
        if (hand == 0) cold();
        const double before = cpu_us();
        exchange(*drives);
        us += cpu_us() - before;
        drain(theirs);
      }
      least_us = std::min(least_us, us);
    }
    worst_us = std::max(worst_us, least_us);
  }
  return worst_us;
}

int exchanges_per_tick(const device::Device& device) {
  std::array<int, 2> ends{};
  if (socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_NONBLOCK | SOCK_CLOEXEC, 0, ends.data()) != 0) return 0;
  platform::SocketBus ours(ends[0]), theirs(ends[1]);
  const auto drives = platform::make_drives(ours, device, 20, 0);
  const auto samples = drives->example_samples();
  for (const can::Frame& sample : samples) theirs.send(sample);
  exchange(*drives);
  return std::max(drain(theirs), static_cast<int>(samples.size()));
}

}  // namespace ligature::app
