#include "host/view/trace_row.hpp"

#include <algorithm>

#include "host/tick_statistics.hpp"

namespace ligature::host::view {

TraceRow trace_row(const ligature_msg::tick_t& tick) {
  TraceRow row{};
  row[kTick] = static_cast<double>(tick.tick);
  for (std::size_t hand = 0; hand < 2; ++hand) {
    const std::size_t at = hand == 0 ? kLeftX : kRightX;
    std::ranges::copy(tick.f_device_N[hand], row.begin() + static_cast<std::ptrdiff_t>(at));
    row[at + 3] = magnitude(tick.f_device_N[hand]);
    row[hand == 0 ? kLeftNode : kRightNode] = tick.grasped_node[hand];
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
    open_.low[kTick] = open_.high[kTick] = static_cast<float>(number);  // the bin's number: exact in a float for 9 days
    return finished;
  }
  const auto flags = static_cast<int>(open_.high[kFlags]) | static_cast<int>(row[kFlags]);
  for (std::size_t c = kTick + 1; c < kColumns; ++c) {
    open_.low[c] = std::min(open_.low[c], static_cast<float>(row[c]));
    open_.high[c] = std::max(open_.high[c], static_cast<float>(row[c]));
  }
  open_.high[kFlags] = static_cast<float>(flags);
  return false;
}

}  // namespace ligature::host::view
