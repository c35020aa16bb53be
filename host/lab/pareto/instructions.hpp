#pragma once

#include <optional>

#include "host/lab/pareto/setting.hpp"
#include "host/lab/statistics.hpp"

namespace ligature::lab {

/// Instruction counts of the ticks of the knot's pull, measured by running this program again under callgrind; nothing
/// without valgrind. @param ticks number of ticks. About 40 times slower than the ticks themselves.
[[nodiscard]] std::optional<Spread> count_instructions(const Setting& setting, int ticks);

}  // namespace ligature::lab
