#pragma once
#include <array>
#include <cstddef>
#include <cstdint>

#include "ligature_msg/tick_t.hpp"

namespace ligature::host::view {

/// The values of a tick that the page's traces need, in the order in which they are sent (docs/view.md; same list in
/// page/frame.js).
enum Column : std::size_t {
  kTick,
  kLeftX,  // f_device_N of the left hand: x, y, z and magnitude
  kLeftY,
  kLeftZ,
  kLeft,
  kRightX,
  kRightY,
  kRightZ,
  kRight,
  kWakeup_ns,
  kControl_ns,
  kExecution_ns,
  kFlags,
  kState,
  kFault,
  kKinetic_J,
  kPotential_J,
  kMaxStretch,
  kMinGap_m,
  kContacts,
  kLeftNode,
  kRightNode,
  kLeftWorld,  // |f_world_N|: the thread's tension at the hand
  kRightWorld,
  kLeftPort_J,  // energy account of each device port; below, energy removed by the passivity controller
  kRightPort_J,
  kLeftDissipated_J,
  kRightDissipated_J,
  kLeftBusLoad,
  kRightBusLoad,
  kLeftHeat,
  kRightHeat,
  kLeftLimits,  // LIMIT_ bits of tick_t
  kRightLimits,
  kLeftClutch,  // 1: clutch engaged, the tool stays where it is
  kRightClutch,
  kDegradation,      // DEGRADED_ value of tick_t
  kThreadDone_ns,    // from the wake-up until the thread's physics was done; 0: it was late
  kTimeLost,         // fraction of the tick in which the thread was not moved
  kLeftPropagation,  // PROPAGATION_ value of tick_t
  kRightPropagation,
  kColumns
};

/// Doubles, because they hold every field of tick_t without loss: a value shown in the page equals the exported one to
/// the last bit.
using TraceRow = std::array<double, kColumns>;

[[nodiscard]] TraceRow trace_row(const ligature_msg::tick_t& tick);

/// Smallest and largest value of each column over kTicksPerBin consecutive ticks; a tick belongs to bin tick /
/// kTicksPerBin.
/// kTick holds the bin's number in two parts, low + high * kBinNumberPart, because a single float would be exact for
/// the first 9 days only. kFlags and the limits: `high` is the bitwise or, so that one late tick among fifty is never
/// hidden.
struct TraceBin {
  std::array<float, kColumns> low{}, high{};
};
inline constexpr std::int64_t kTicksPerBin = 50, kBinNumberPart = std::int64_t{1} << 20;

/// Combines rows into bins.
class BinMaker {
 public:
  /// @return whether this row completes a bin by starting the next one; then `done` is the complete bin.
  bool add(const TraceRow& row, TraceBin& done);
  void clear() { number_ = -1; }

 private:
  TraceBin open_;
  std::int64_t number_ = -1;
};

}  // namespace ligature::host::view
