#pragma once

namespace ligature::app {

/// CPU time of a tick's calls to both buses, us: SYNC, six TPDOs, six RPDOs. Measured on a socket of its own with cold
/// caches, the least of three repetitions, the worst of some ticks: what the kernel needs to pass frames on. A CAN
/// driver's own time is not in it.
[[nodiscard]] double bus_calls_us();

}  // namespace ligature::app
