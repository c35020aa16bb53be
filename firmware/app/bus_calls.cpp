#include "firmware/app/bus_calls.hpp"

#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <memory>
#include <vector>

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

/// The drives of a hand on one end of a pair of local sockets.
struct LocalDrives {
  LocalDrives(const std::array<int, 2>& ends, const device::Device& device)
      : ours(ends[0]), theirs(ends[1]), drives(platform::make_drives(ours, device, 20, 0)) {}
  platform::SocketBus ours, theirs;
  std::unique_ptr<platform::HandDrives> drives;
  std::vector<can::Frame> samples = drives->example_samples();
};

/// @return nothing if the kernel gives no sockets
std::unique_ptr<LocalDrives> local_drives(const device::Device& device) {
  std::array<int, 2> ends{};
  if (socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_NONBLOCK | SOCK_CLOEXEC, 0, ends.data()) != 0) return nullptr;
  return std::make_unique<LocalDrives>(ends, device);
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
  const auto local = local_drives(device);
  if (!local) return 0.0;
  ColdCaches cold;
  double worst_us = 0.0;
  for (int tick = 0; tick < kTicks; ++tick) {
    double least_us = 1e12;
    for (int repeat = 0; repeat < kRepeats; ++repeat) {
      double us = 0.0;
      for (std::size_t hand = 0; hand < rt::kHands; ++hand) {
        for (const can::Frame& sample : local->samples) local->theirs.send(sample);
        if (hand == 0) cold();
        const double before = cpu_us();
        exchange(*local->drives);
        us += cpu_us() - before;
        drain(local->theirs);
      }
      least_us = std::min(least_us, us);
    }
    worst_us = std::max(worst_us, least_us);
  }
  return worst_us;
}

int exchanges_per_tick(const device::Device& device) {
  const auto local = local_drives(device);
  if (!local) return 0;
  for (const can::Frame& sample : local->samples) local->theirs.send(sample);
  exchange(*local->drives);
  return std::max(drain(local->theirs), static_cast<int>(local->samples.size()));
}

}  // namespace ligature::app
