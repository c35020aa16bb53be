#pragma once
// CSV reader for gripper scripts and polylines: strict, and names the line that it refuses.

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "protocol/scene/cells.hpp"  // parse_number, for readers of rows
#include "protocol/scene/scene.hpp"

namespace ligature::scene {

inline constexpr std::size_t kMostRows = 200'000;  ///< two hands for a minute at 1 kHz, with reserve

struct CsvRow {
  std::size_t line = 0;  ///< line number in the file, from 1
  std::vector<std::string> cells;
};

/// An optional line `key,value` before the header.
struct CsvSetting {
  std::string_view key;
  std::string value{};
  std::size_t line = 0;  ///< line number; 0: not found
};

/// Reads a CSV file of at most kMostCsv_bytes and kMostRows. `#` starts a comment; empty lines are skipped; blanks
/// around cells are dropped. The first remaining line must be `header` or, if given, `wider`; each row must have as
/// many cells as that line. `setting`, if given, may appear once before the header.
/// @return the rows below the header (at least one), or one line that names file, line, what was found and what is
/// allowed.
[[nodiscard]] std::variant<std::vector<CsvRow>, Error> read_csv(const std::filesystem::path& path,
                                                                std::string_view header, std::string_view wider = {},
                                                                CsvSetting* setting = nullptr);

/// Untrusted text for use in a message: control characters as \xNN, at most 60 characters.
[[nodiscard]] std::string shown(std::string_view text);

/// The text; if it is longer than `most` characters, only the whole words that fit, and "..".
[[nodiscard]] std::string shortened(std::string_view text, std::size_t most);

/// "FILE:LINE: what"
[[nodiscard]] Error at_line(const std::filesystem::path& path, std::size_t line, std::string_view what);

}  // namespace ligature::scene
