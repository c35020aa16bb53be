#include "host/lab/report.hpp"

#include <algorithm>
#include <cstdio>

#include "host/lab/outcome.hpp"
#include "host/lab/run_files.hpp"

namespace ligature::lab {
namespace {

std::string text_of(const Cell& cell, int significant) {
  if (const auto* text = std::get_if<std::string>(&cell)) return *text;
  return digits(std::get<double>(cell), significant);
}

/// A CSV cell; texts with commas are put in quotation marks.
std::string quoted(std::string text) {
  if (text.find(',') == std::string::npos) return text;
  return "\"" + text + "\"";
}

}  // namespace

std::string digits(double value, int significant) {
  char text[40];
  std::snprintf(text, sizeof text, "%.*g", significant, value);
  return text;
}

void Table::print() const {
  std::vector<std::size_t> width;
  width.reserve(columns_.size());
  for (const auto& c : columns_) width.push_back(c.size());
  for (const auto& row : rows_) {
    for (std::size_t k = 0; k < row.size(); ++k) width[k] = std::max(width[k], text_of(row[k], 4).size());
  }
  const auto put = [&](std::size_t k, const std::string& text) {
    std::printf("%s%-*s", k == 0 ? "" : "  ", static_cast<int>(width[k]), text.c_str());
  };
  for (std::size_t k = 0; k < columns_.size(); ++k) put(k, columns_[k]);
  std::printf("\n");
  for (const auto& row : rows_) {
    for (std::size_t k = 0; k < row.size(); ++k) put(k, text_of(row[k], 4));
    std::printf("\n");
  }
  std::fflush(stdout);
}

void Table::write(const std::filesystem::path& path) const {
  std::string text;
  for (std::size_t k = 0; k < columns_.size(); ++k) text += (k == 0 ? "" : ",") + columns_[k];
  text += '\n';
  for (const auto& row : rows_) {
    for (std::size_t k = 0; k < row.size(); ++k) text += (k == 0 ? "" : ",") + quoted(text_of(row[k], 10));
    text += '\n';
  }
  write_text(path, text);
}

void Verdict::claim(bool holds, const std::string& what, const std::string& measured, const std::string& allowed) {
  claims_.push_back({holds, what, measured, allowed});
}

int Verdict::conclude(const std::filesystem::path& folder) const {
  Table table({"verdict", "claim", "measured", "allowed"});
  bool all = true;
  for (const auto& c : claims_) {
    std::printf("%s %s: %s: %s (allowed %s)\n", c.holds ? "PASS" : "FAIL", experiment_.c_str(), c.what.c_str(),
                c.measured.c_str(), c.allowed.c_str());
    table.row({std::string(c.holds ? "PASS" : "FAIL"), c.what, c.measured, c.allowed});
    all = all && c.holds;
  }
  table.write(folder / (experiment_ + "-verdict.csv"));
  std::fflush(stdout);
  return all ? kDone : kRunFailed;
}

}  // namespace ligature::lab
