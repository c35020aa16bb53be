#pragma once
#include <array>
#include <cstddef>
#include <cstdint>

#include "ligature_msg/tick_t.hpp"

namespace ligature::host::view {

/// What the page's traces know of one tick, in the order of the wire (docs/view.md; page/frame.js has the same list).
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
  kLeftPort_J,  // account of the device port, and what the passivity controller has taken out
  kRightPort_J,
  kLeftDissipated_J,
  kRightDissipated_J,
  kLeftBusLoad,
  kRightBusLoad,
  kLeftHeat,
  kRightHeat,
  kLeftLimits,  // LIMIT_ bits of tick_t
  kRightLimits,
  kLeftClutch,  // 1: the tool is parked
  kRightClutch,
  kDegradation,  // DEGRADED_ value of tick_t
  kThreadDone_ns,  // of the thread's physics; 0: it was late
  kTimeLost,       // share of the tick in which the thread stood still
  kColumns
};

/// Doubles throughout: every field of tick_t that is shown fits without loss, so that a value read in the page is the
/// exported one to the last bit.
using TraceRow = std::array<double, kColumns>;

[[nodiscard]] TraceRow trace_row(const ligature_msg::tick_t& tick);

/// Smallest and largest value of each column over kTicksPerBin consecutive tick numbers (by tick / kTicksPerBin).
/// kTick: the bin's number in two parts, low + high * kBinNumberPart: one float alone is exact for 9 days only.
/// kFlags and the limits: `low` and, joined by or, `high`; so that one late tick among fifty is never hidden.
struct TraceBin {
  std::array<float, kColumns> low{}, high{};
};
inline constexpr std::int64_t kTicksPerBin = 50, kBinNumberPart = std::int64_t{1} << 20;

/// Collects rows into bins.
class BinMaker {
 public:
  /// @return whether a bin was finished by the start of the next one; then `done` is it.
  bool add(const TraceRow& row, TraceBin& done);
  void clear() { number_ = -1; }

 private:
  TraceBin open_;
  std::int64_t number_ = -1;
};

}  // namespace ligature::host::view
