#include "host/lab/validate/reference.hpp"

#include <sstream>
#include <stdexcept>

namespace ligature::validate {
namespace {

std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells(1);
  bool quoted = false;
  for (const char c : line.substr(0, line.find('\r'))) {
    if (c == '"') {
      quoted = !quoted;
    } else if (c == ',' && !quoted) {
      cells.emplace_back();
    } else {
      cells.back() += c;
    }
  }
  return cells;
}

}  // namespace

std::string reference_text(const std::string& name) {
  for (std::size_t k = 0; k < kEmbeddedTableCount; ++k) {
    if (name == kEmbeddedTables[k].name) return kEmbeddedTables[k].text;
  }
  throw std::runtime_error("no reference table " + name);
}

std::vector<Row> reference_rows(const std::string& name) {
  std::stringstream text(reference_text(name));
  std::string line;
  while (std::getline(text, line) && line.starts_with('#')) {  // skips comments before the header
  }
  const auto header = cells_of(line);
  std::vector<Row> rows;
  while (std::getline(text, line)) {
    const auto cells = cells_of(line);
    Row row;
    for (std::size_t i = 0; i < cells.size() && i < header.size(); ++i) row[header[i]] = cells[i];
    if (!row.empty()) rows.push_back(std::move(row));
  }
  return rows;
}

}  // namespace ligature::validate
