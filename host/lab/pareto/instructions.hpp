#pragma once

#include <optional>

#include "host/lab/pareto/setting.hpp"
#include "host/lab/statistics.hpp"

namespace ligature::lab {

/// Instructions of every tick of the knot's pull, counted by callgrind running this program again; nothing when there
/// is no valgrind. @param ticks how many. About 40 times slower than the ticks themselves.
[[nodiscard]] std::optional<Spread> count_instructions(const Setting& setting, int ticks);

}  // namespace ligature::lab
