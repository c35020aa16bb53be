#pragma once
// Reads the tables of tests/reference: truth computed elsewhere (see the README there).

#include <fstream>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace ligature::test {

/// Rows of a table by column name; text cells are kept as text.
struct Table {
  std::vector<std::map<std::string, std::string>> rows;
};

inline Table read_table(const std::string& name) {
  std::ifstream file(std::string(LIGATURE_SOURCE_DIR) + "/tests/reference/" + name);
  if (!file) throw std::runtime_error("tests/reference/" + name + " is missing");
  const auto split = [](const std::string& line) {
    std::vector<std::string> cells;
    std::stringstream in(line.substr(0, line.find('\r')));
    for (std::string cell; std::getline(in, cell, ',');) cells.push_back(cell);
    return cells;
  };
  std::string line;
  std::getline(file, line);
  const auto header = split(line);
  Table table;
  while (std::getline(file, line)) {
    const auto cells = split(line);
    std::map<std::string, std::string> row;
    for (std::size_t i = 0; i < cells.size() && i < header.size(); ++i) row[header[i]] = cells[i];
    table.rows.push_back(row);
  }
  return table;
}

inline double number(const std::map<std::string, std::string>& row, const std::string& column) {
  return std::stod(row.at(column));
}

}  // namespace ligature::test
