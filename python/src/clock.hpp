#pragma once
#include "host/rig_facts.hpp"

namespace ligature::python {

/// Tells the time of a tick as a recording of that period does.
[[nodiscard]] inline host::RigFacts clock_of(double tick_s) {
  host::RigFacts clock;
  clock.period_s = tick_s;
  return clock;
}

}  // namespace ligature::python
