#pragma once
// The file of expected figures, and the comparison of measured figures with it.

#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "host/lab/regress/scene.hpp"

namespace ligature::regress {

struct Expectation {
  double value = 0.0, tolerance = 0.0;
};
/// By scene and name of the figure.
using Expectations = std::map<std::pair<std::string, std::string>, Expectation>;

enum class Verdict { kSame, kMoved, kBeyond, kNew, kGone };
[[nodiscard]] const char* name(Verdict verdict) noexcept;

/// One line of the comparison. kNew: the file does not have the figure; kGone: only the file has it.
struct Line {
  std::string scene, figure;
  Expectation expected;
  double measured = 0.0;
  Verdict verdict = Verdict::kSame;
};

/// Measured figures of the scenes, in the order of the table.
using Measured = std::vector<std::pair<std::string, Figures>>;

/// Reads a text with the columns scene,figure,expected,tolerance. @throws lab::Refusal naming `name` and the line.
[[nodiscard]] Expectations read_expected(const std::string& text, const std::string& name);
/// The text of expected.csv, compiled into the program.
[[nodiscard]] const char* embedded_expected() noexcept;

/// Compares every measured figure. Figures are equal if they agree in the nine digits that the file has. A value that
/// is not finite is beyond every tolerance. Scenes that were not measured are left out.
[[nodiscard]] std::vector<Line> compare(const Measured& measured, const Expectations& expected);

/// The new text of the file with expected figures: the measured values; each figure's tolerance as before, and for a
/// new figure the tolerance that its scene states.
[[nodiscard]] std::string write_expected(const Measured& measured, const Expectations& before);

}  // namespace ligature::regress
