#pragma once

#include "protocol/device/device.hpp"

namespace ligature::app {

/// CPU time of one tick's exchange with both hands' drives in us: what the loop sends and reads, with coding and
/// decoding. Measured on a socket pair with cold caches: the least of three repetitions of a tick, and of these the
/// largest over all ticks. A CAN driver's own time is not included.
[[nodiscard]] double bus_calls_us(const device::Device& device);

}  // namespace ligature::app
