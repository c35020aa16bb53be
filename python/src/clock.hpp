#pragma once
#include "host/rig_facts.hpp"

namespace ligature::python {

/// A clock whose time_s() gives the same times of ticks as a recording with that period.
[[nodiscard]] inline host::RigFacts clock_of(double tick_s) {
  host::RigFacts clock;
  clock.period_s = tick_s;
  return clock;
}

}  // namespace ligature::python
