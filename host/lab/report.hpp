#pragma once
// Results of an experiment: tables, and claims with their verdicts.

#include <filesystem>
#include <initializer_list>
#include <string>
#include <variant>
#include <vector>

namespace ligature::lab {

using Cell = std::variant<double, std::string>;

/// A table with named columns (units in the names), printed aligned and written as CSV.
class Table {
 public:
  explicit Table(std::vector<std::string> columns) : columns_(std::move(columns)) {}
  void row(std::vector<Cell> cells) { rows_.push_back(std::move(cells)); }
  void print() const;
  void write(const std::filesystem::path& path) const;

 private:
  std::vector<std::string> columns_;
  std::vector<std::vector<Cell>> rows_;
};

/// The claims of an experiment, each with the measured number that decides it.
class Verdict {
 public:
  explicit Verdict(std::string experiment) : experiment_(std::move(experiment)) {}
  void claim(bool holds, const std::string& what, const std::string& measured, const std::string& allowed);
  /// Prints a PASS or FAIL line per claim and writes EXPERIMENT-verdict.csv.
  /// @return kDone, or kRunFailed when a claim does not hold.
  int conclude(const std::filesystem::path& folder) const;

 private:
  struct Claim {
    bool holds;
    std::string what, measured, allowed;
  };
  std::string experiment_;
  std::vector<Claim> claims_;
};

/// A number with a few significant digits, for use in sentences.
[[nodiscard]] std::string digits(double value, int significant = 3);

/// Draws a picture with `python host/lab/plots/SCRIPT DATA.. PICTURE`; prints a message when there is no Python.
void draw(const std::string& script, const std::vector<std::filesystem::path>& data,
          const std::filesystem::path& picture);

}  // namespace ligature::lab
