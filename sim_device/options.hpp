#pragma once
// Command line of ligature-device.

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
  std::string scene;   ///< empty: default workspace mapping
  std::string script;  ///< empty: the hand rests; "page": steered from a page; "tie:KNOT[:SEED]"
  std::string lcm_url{lcm_tools::kDefaultUrl};
  std::string stats;   ///< file for statistics; empty: none
  std::string faults;  ///< fault script; empty: no faults
  std::vector<std::string> overrides;
  bool exit_when_done = false;
  bool real_time = false;
  int cpu = -1;  ///< CPU to run on; -1: any

  std::string device;  ///< device record; empty: the Omni class
  std::string hold;    ///< see hand_of(); empty: a light stylus grip
  double tremor_mm = 0.0, tremor_Hz = 10.0;
  double adversary_lead_s = 0.0, adversary_reach_mm = 5.0;
  bool links_bend = false;
  double gravity_share = 0.0;
  std::uint32_t seed = 1;

  [[nodiscard]] bool is_steered() const { return script == "page"; }
  [[nodiscard]] bool is_tying() const {
    return script.starts_with("tie:") || script == "untie" || script.starts_with("untie:");
  }
  [[nodiscard]] std::string hand() const { return is_left ? "left" : "right"; }
};

/// The hand named by --hold: loose, light, firm, clenched, none, or a tightness 0 .. 1; nothing for another word.
[[nodiscard]] std::optional<Hand> hand_of(const std::string& hold);

/// @return the options, or the exit code if nothing is left to do: help and version (0), bad usage (2, one line on
/// stderr).
[[nodiscard]] std::variant<Options, int> parse_options(int argc, char** argv);

}  // namespace ligature::sim
