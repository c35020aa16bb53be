#pragma once

#include "protocol/device/device.hpp"

namespace ligature::app {

/// CPU time of one tick's exchange with the drives of both hands, us: sending, reading, coding and decoding. It is
/// measured on a pair of local sockets, with cold caches. Each tick runs three times, and its shortest time counts. The
/// result is the largest over all ticks. A CAN driver's own time is not included.
[[nodiscard]] double bus_calls_us(const device::Device& device);

/// The larger of the numbers of frames that a hand's exchange of one tick sends and receives.
[[nodiscard]] int exchanges_per_tick(const device::Device& device);

}  // namespace ligature::app
