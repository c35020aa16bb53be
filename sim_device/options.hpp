#pragma once
// The command line of ligature-device.

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "protocol/lcm/default_url.hpp"
#include "sim_device/hand.hpp"

namespace ligature::sim {

struct Options {
  bool is_left = true;
  std::string bus;
  std::string scene;   ///< empty: default workspace
  std::string script;  ///< empty: the hand rests; "page": whoever steers it from a page
  std::string lcm_url{lcm_tools::kDefaultUrl};
  std::string stats;   ///< empty: none
  std::string faults;  ///< empty: nothing goes wrong
  std::vector<std::string> overrides;
  bool exit_when_done = false;
  bool real_time = false;
  int cpu = -1;  ///< -1: any

  std::string device;  ///< record; empty: the Omni class
  std::string hold;    ///< empty: a light stylus grip
  double tremor_mm = 0.0, tremor_Hz = 10.0;
  double adversary_lead_s = 0.0, adversary_reach_mm = 5.0;
  bool links_bend = false;
  double gravity_share = 0.0;
  std::uint32_t seed = 1;

  [[nodiscard]] bool is_steered() const { return script == "page"; }
  [[nodiscard]] std::string hand() const { return is_left ? "left" : "right"; }
};

/// The hand that --hold names: loose, light, firm, clenched, none, or a tightness 0 .. 1; nothing for another word.
[[nodiscard]] std::optional<Hand> hand_of(const std::string& hold);

/// Options, or the exit code of a command line that is over (help, version: 0; a mistake: 2, told in one line).
[[nodiscard]] std::variant<Options, int> parse_options(int argc, char** argv);

}  // namespace ligature::sim
