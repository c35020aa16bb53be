#pragma once
// The one small CSV reader behind gripper scripts and polylines: strict, and exact about the line it refuses.

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "protocol/scene/cells.hpp"  // parse_number, for those who read rows
#include "protocol/scene/scene.hpp"

namespace ligature::scene {

inline constexpr std::size_t kMostRows = 200'000;  ///< two hands, a minute at 1 kHz, and some more

struct CsvRow {
  std::size_t line = 0;  ///< in the file, from 1
  std::vector<std::string> cells;
};

/// A line `key,value` that may stand before the header.
struct CsvSetting {
  std::string_view key;
  std::string value{};
  std::size_t line = 0;  ///< where it was found; 0: it was not
};

/// Reads a CSV file of at most kMostCsv_bytes and kMostRows: `#` starts a comment, empty lines are skipped, blanks
/// around cells are dropped, the first line that is left must be `header` (as written, blanks aside), or `wider` where
/// there is one, and every row must have as many cells as it. `setting`, where there is one, may come before the
/// header, once.
/// @return the rows below the header (at least one), or one line that names file, line, what was found and what is
/// allowed.
[[nodiscard]] std::variant<std::vector<CsvRow>, Error> read_csv(const std::filesystem::path& path,
                                                                std::string_view header, std::string_view wider = {},
                                                                CsvSetting* setting = nullptr);

/// Foreign text as it may stand in a message: control characters as \xNN, at most 60 characters.
[[nodiscard]] std::string shown(std::string_view text);

/// "FILE:LINE: what"
[[nodiscard]] Error at_line(const std::filesystem::path& path, std::size_t line, std::string_view what);

}  // namespace ligature::scene
