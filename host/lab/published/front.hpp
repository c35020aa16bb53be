#pragma once
// What speed costs in truth: the cost of a tick against the largest error of each published case, setting by setting.

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

/// The settings of a --settings and the --work options. @pre `text` is balanced, fine, both or all.
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
  /// The largest error of a judged figure, as a multiple of its tolerance: up to 1 the case is met. Infinite: a figure
  /// that is right or wrong is wrong, or one is no number.
  [[nodiscard]] double worst() const;
};

/// Prints the front as a table: a row for each case with motion and each setting.
void print_front(const std::vector<Outcome>& outcomes);
/// Writes front.csv and, with Python, front.png.
void write_front(const std::filesystem::path& folder, const std::vector<Outcome>& outcomes);

}  // namespace ligature::published
