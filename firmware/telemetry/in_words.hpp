#pragma once
// Words for the part of the rig that a message is about.

#include <array>
#include <cstdio>
#include <string>

#include "firmware/rt/culprit.hpp"
#include "firmware/rt/rig_io.hpp"

namespace ligature::telemetry {

/// Such as "left hand, shoulder (node 2), error code 0x3210 (12816)"; empty if there is no hand.
[[nodiscard]] inline std::string in_words(const rt::Culprit& c) {
  static constexpr std::array kHandWords{"left hand", "right hand"};
  static constexpr std::array kJointWords{"waist (node 1)", "shoulder (node 2)", "forearm (node 3)", "button module"};
  if (c.hand < 0) return {};
  std::string text = kHandWords[static_cast<std::size_t>(c.hand)];
  if (c.joint >= 0) text += std::string(", ") + kJointWords[static_cast<std::size_t>(c.joint)];
  if (c.error == 0) return text;
  std::array<char, 48> code{};
  std::snprintf(code.data(), code.size(), ", error code 0x%04X (%u)", static_cast<unsigned>(c.error),
                static_cast<unsigned>(c.error));
  return text + code.data();
}

/// Such as "fault 12: drive fault, left hand". @param name of the fault
[[nodiscard]] inline std::string fault_in_words(int fault, const char* name, const rt::Culprit& c) {
  const std::string where = in_words(c);
  return "fault " + std::to_string(fault) + ": " + name + (where.empty() ? "" : ", " + where);
}

}  // namespace ligature::telemetry
