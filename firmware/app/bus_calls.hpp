#pragma once

namespace ligature::app {

/// CPU time of one tick's calls to both buses in us: SYNC, six TPDOs, six RPDOs. Measured on a socket pair with cold
/// caches: the least of three repetitions of a tick, and of these the largest over all ticks. A CAN driver's own time
/// is not included.
[[nodiscard]] double bus_calls_us();

}  // namespace ligature::app
