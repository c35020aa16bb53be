#pragma once
// The reference tables of tests/reference, computed independently (see the README there) and compiled into the program.

#include <cstddef>
#include <map>
#include <string>
#include <vector>

namespace ligature::validate {

struct EmbeddedTable {
  const char* name;
  const char* text;
};
extern const EmbeddedTable kEmbeddedTables[];
extern const std::size_t kEmbeddedTableCount;

/// One row of a table by column name; cells are kept as text.
using Row = std::map<std::string, std::string>;

/// The text of a table. @throws std::runtime_error when no table has that name.
[[nodiscard]] std::string reference_text(const std::string& name);

/// The rows of a CSV table. @throws std::runtime_error.
[[nodiscard]] std::vector<Row> reference_rows(const std::string& name);

/// A cell as a number. @throws std::out_of_range when the column does not exist.
[[nodiscard]] inline double number(const Row& row, const std::string& column) { return std::stod(row.at(column)); }

}  // namespace ligature::validate
