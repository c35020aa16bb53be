#include "host/view/trace_row.hpp"

#include <algorithm>
#include <iterator>

#include "host/tick_statistics.hpp"

namespace ligature::host::view {

TraceRow trace_row(const ligature_msg::tick_t& tick) {
  TraceRow row{};
  row[kTick] = static_cast<double>(tick.tick);
  for (std::size_t hand = 0; hand < 2; ++hand) {
    const std::size_t at = hand == 0 ? kLeftX : kRightX;
    std::ranges::copy(tick.f_device_N[hand], row.begin() + static_cast<std::ptrdiff_t>(at));
    row[at + 3] = magnitude(tick.f_device_N[hand]);
    row[kLeftNode + hand] = tick.grasped_node[hand];
    row[kLeftWorld + hand] = magnitude(tick.f_world_N[hand]);
    row[kLeftPort_J + hand] = tick.port_energy_J[hand];
    row[kLeftDissipated_J + hand] = tick.dissipated_J[hand];
    row[kLeftBusLoad + hand] = static_cast<double>(tick.bus_load[hand]);
    row[kLeftHeat + hand] = tick.heat[hand];
    row[kLeftLimits + hand] = tick.limits[hand];
    row[kLeftClutch + hand] = tick.clutch[hand];
    row[kLeftPropagation + hand] = tick.propagation[hand];
  }
  row[kWakeup_ns] = tick.wakeup_latency_ns;
  row[kControl_ns] = tick.control_ns;
  row[kExecution_ns] = tick.execution_ns;
  row[kFlags] = tick.flags;
  row[kState] = tick.state;
  row[kFault] = tick.fault;
  row[kKinetic_J] = tick.kinetic_J;
  row[kPotential_J] = tick.potential_J;
  row[kMaxStretch] = tick.max_stretch;
  row[kMinGap_m] = tick.min_gap_m;
  row[kContacts] = tick.contacts;
  row[kDegradation] = tick.degradation;
  row[kThreadDone_ns] = tick.thread_done_ns;
  row[kTimeLost] = static_cast<double>(tick.time_lost);
  return row;
}

bool BinMaker::add(const TraceRow& row, TraceBin& done) {
  const auto number = static_cast<std::int64_t>(row[kTick]) / kTicksPerBin;
  const bool is_new = number != number_;
  const bool finished = is_new && number_ >= 0;
  if (finished) done = open_;
  if (is_new) {
    number_ = number;
    for (std::size_t c = 0; c < kColumns; ++c) open_.low[c] = open_.high[c] = static_cast<float>(row[c]);
    open_.low[kTick] = static_cast<float>(number % kBinNumberPart);
    const auto high = number / kBinNumberPart;  // the whole part
    open_.high[kTick] = static_cast<float>(high);
    return finished;
  }
  constexpr std::size_t kBits[] = {kFlags, kLeftLimits, kRightLimits};
  std::array<int, std::size(kBits)> joined{};
  for (std::size_t k = 0; k < joined.size(); ++k)
    joined[k] = static_cast<int>(open_.high[kBits[k]]) | static_cast<int>(row[kBits[k]]);
  for (std::size_t c = kTick + 1; c < kColumns; ++c) {
    open_.low[c] = std::min(open_.low[c], static_cast<float>(row[c]));
    open_.high[c] = std::max(open_.high[c], static_cast<float>(row[c]));
  }
  for (std::size_t k = 0; k < joined.size(); ++k) open_.high[kBits[k]] = static_cast<float>(joined[k]);
  return false;
}

}  // namespace ligature::host::view
