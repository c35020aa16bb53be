#pragma once
// Checks of what shares the loop's core: a second hardware thread, and interrupt threads with a higher priority than
// the loop.

#include <vector>

#include "firmware/platform/machine.hpp"

namespace ligature::platform {

[[nodiscard]] std::vector<Check> check_core(const Machine& machine, int core);

}  // namespace ligature::platform
