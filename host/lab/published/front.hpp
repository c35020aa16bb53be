#pragma once
// What a cheaper setting costs in accuracy: for each setting, the cost of a tick and the largest error of each
// published case.

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "host/lab/published/case.hpp"

namespace ligature::published {

/// A setting at which cases are run: a value of suture.accuracy and, if not 0, a contact budget.
struct Setting {
  std::string name;
  scene::Accuracy accuracy = scene::Accuracy::kBalanced;
  long work = 0;
};

/// The settings that the options --settings (`text`) and --work (`budgets`) select. @pre `text` is balanced, fine, both
/// or all.
[[nodiscard]] std::vector<Setting> settings_of(const std::string& text, const std::vector<long>& budgets);

/// One case at one setting.
struct Outcome {
  const Case* examined = nullptr;
  std::string setting;
  Result result;
  std::int64_t ticks = 0;  ///< simulated; 0: the case has no motion
  double cpu_us = 0.0;     ///< CPU time of the case

  [[nodiscard]] int judged() const;
  [[nodiscard]] int missed() const;
  /// The largest error of a judged figure, as a multiple of its tolerance: up to 1 the case is met. Infinite if a
  /// yes-or-no figure is wrong, or if a figure is not a number.
  [[nodiscard]] double worst() const;
};

/// A row of front.csv: the cost of one case at one setting, and its error.
struct FrontRow {
  std::string examined, setting;
  double ticks = 0.0, tick_us = 0.0;
  double worst = 0.0;  ///< Outcome::worst()
  double judged = 0.0, missed = 0.0;
};

/// One setting over all cases.
struct Overall {
  std::string setting;
  double tick_us = 0.0;  ///< mean of the cases, each with the same weight
  double cases = 0.0, cases_met = 0.0, judged = 0.0, missed = 0.0;
  bool on_front = false;  ///< no other setting misses fewer figures at the same or less cost, or as many at less
};

/// The rows of all cases that move.
[[nodiscard]] std::vector<FrontRow> front_of(const std::vector<Outcome>& outcomes);

/// Sums up, for each setting, the cases that were run at every setting: with other cases included, the settings could
/// not be compared.
[[nodiscard]] std::vector<Overall> over_all_cases(const std::vector<FrontRow>& rows);

/// Prints the rows, and the settings over all cases.
void print_front(const std::vector<FrontRow>& rows);
void print_overall(const std::vector<Overall>& settings);

/// Writes front.csv and, with Python, front.png.
void write_front(const std::filesystem::path& folder, const std::vector<FrontRow>& rows);
void write_overall(const std::filesystem::path& file, const std::vector<Overall>& settings);

/// Reads the front.csv of a folder. @throws Refusal.
[[nodiscard]] std::vector<FrontRow> read_front(const std::filesystem::path& folder);

}  // namespace ligature::published
