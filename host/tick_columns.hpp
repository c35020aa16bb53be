#pragma once
#include <cstdint>
#include <functional>
#include <string>
#include <variant>
#include <vector>

#include "ligature_msg/tick_t.hpp"

namespace ligature::host {

/// One field of a tick as a column: its name in files of every format, its unit and its meaning.
struct TickColumn {
  using Whole = std::function<std::int64_t(const ligature_msg::tick_t&)>;
  using Real = std::function<double(const ligature_msg::tick_t&)>;
  std::string name, unit, meaning;  ///< unit empty: dimensionless
  std::variant<Whole, Real> value;
};

/// Every field of tick_t (protocol/lcm/tick_t.lcm), in the order of ticks.csv; `tick` is the first. A tick does not
/// contain its time or session; the writers add these columns.
[[nodiscard]] const std::vector<TickColumn>& tick_columns();

inline constexpr const char* kTimeMeaning = "tick times control period: since the firmware's start";
inline constexpr const char* kSessionMeaning = "run of the firmware within the recording, from 1";

}  // namespace ligature::host
