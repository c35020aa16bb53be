#pragma once
// Whether a bus is named after a hand, to find hands that were swapped by mistake: nothing on the wire tells them
// apart.

#include <string>
#include <string_view>

namespace ligature::can {

/// A warning for the user if the last part of a bus's address, such as "right" of local:/tmp/right, names only the
/// other hand; else empty. @param hand "left" or "right"
[[nodiscard]] inline std::string doubt_about_hand(std::string_view hand, std::string_view bus) {
  const std::string_view other = hand == "left" ? "right" : "left";
  const auto name = bus.substr(bus.find_last_of("/:") + 1);
  if (name.find(other) == name.npos || name.find(hand) != name.npos) return {};
  return "the bus " + std::string(bus) + " of the " + std::string(hand) + " hand is named after the " +
         std::string(other) + " one: are the hands swapped?";
}

}  // namespace ligature::can
