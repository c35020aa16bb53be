#pragma once
#include <array>
#include <cstdint>
#include <string_view>

#include "ligature_msg/tick_t.hpp"

namespace ligature::host {

inline constexpr std::array<std::string_view, 2> kHandNames{"left", "right"};

/// Word for a STATE_ value of tick_t; "?" for a number that is none.
[[nodiscard]] constexpr std::string_view state_name(std::int8_t state) {
  constexpr std::array<std::string_view, 7> names{"OFF", "CALIBRATE", "IDLE", "ENGAGE", "FORCE", "BRAKE", "FAULT"};
  return state >= 0 && state < static_cast<std::int8_t>(names.size()) ? names[static_cast<std::uint8_t>(state)] : "?";
}
static_assert(state_name(4) == "FORCE");

}  // namespace ligature::host
