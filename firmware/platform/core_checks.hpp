#pragma once
// Checks of what shares the loop's core: a second hardware thread, and threads of interrupts above the loop.

#include <vector>

#include "firmware/platform/machine.hpp"

namespace ligature::platform {

[[nodiscard]] std::vector<Check> check_core(const Machine& machine, int core);

}  // namespace ligature::platform
