#pragma once
// Checks of option values that several subcommands share.

#include <CLI/CLI.hpp>
#include <string>

#include "host/lab/report.hpp"

namespace ligature::lab {

/// Like CLI::Range, but refuses nan, which CLI::Range accepts because every comparison with nan is false.
inline CLI::Validator within(double low, double high) {
  const std::string allowed = digits(low) + " .. " + digits(high);
  return {[=](const std::string& word) {
            double value = 0.0;
            const bool good = CLI::detail::lexical_cast(word, value) && value >= low && value <= high;
            return good ? std::string() : "found '" + word + "', allowed " + allowed;
          },
          "in [" + allowed + "]"};
}

/// Refuses an empty text: a command would take it for an option that was not given. So an unset variable of a shell
/// would become the default.
inline std::string not_empty(const std::string& word) {
  return word.empty() ? "found '', allowed a text of one character or more" : std::string();
}

}  // namespace ligature::lab
