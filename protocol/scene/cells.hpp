#pragma once
// Splitting and parsing of comma-separated lines, shared by all CSV readers here.

#include <charconv>
#include <cmath>
#include <string_view>
#include <system_error>
#include <vector>

namespace ligature::scene {

/// Text without blanks at both ends.
[[nodiscard]] inline std::string_view trim(std::string_view s, std::string_view blanks = " \t\r") noexcept {
  const auto first = s.find_first_not_of(blanks);
  if (first == std::string_view::npos) return {};
  return s.substr(first, s.find_last_not_of(blanks) - first + 1);
}

/// The trimmed cells of a line, as views into it; at least one.
[[nodiscard]] inline std::vector<std::string_view> split(std::string_view line, std::string_view blanks = " \t\r") {
  std::vector<std::string_view> cells;
  for (;;) {
    const auto comma = line.find(',');
    cells.push_back(trim(line.substr(0, comma), blanks));
    if (comma == std::string_view::npos) return cells;
    line.remove_prefix(comma + 1);
  }
}

/// Parses a finite decimal number; false for anything else.
[[nodiscard]] inline bool parse_number(std::string_view cell, double& out) noexcept {
  if (!cell.empty() && cell.front() == '+') cell.remove_prefix(1);
  const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), out);
  return error == std::errc{} && end == cell.data() + cell.size() && std::isfinite(out);
}

}  // namespace ligature::scene
