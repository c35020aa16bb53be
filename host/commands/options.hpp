#pragma once
// Option checks that several subcommands share.

#include <CLI/CLI.hpp>
#include <cmath>
#include <filesystem>
#include <string>

#include "host/errors.hpp"

namespace ligature::host {

inline void refuse_same_file(const std::string& log, const std::string& target) {
  std::error_code none;
  if (!target.empty() && std::filesystem::equivalent(log, target, none))
    throw BadInput(target + ": is the log itself; allowed: another name");
}

/// Rejects nan and inf. CLI11's range checks let nan pass, because every comparison with nan is false.
inline std::string finite(const std::string& word) {
  double value = 0.0;
  if (CLI::detail::lexical_cast(word, value) && !std::isfinite(value))
    return "found '" + word + "', allowed a finite number";
  return {};
}

inline void add_url(CLI::App& command, std::string& url) {
  command.add_option("--lcm-url", url, "LCM network; ttl=0 keeps every packet on this machine")->capture_default_str();
}

}  // namespace ligature::host
