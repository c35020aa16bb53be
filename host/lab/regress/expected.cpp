#include "host/lab/regress/expected.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <sstream>

#include "host/lab/outcome.hpp"
#include "host/lab/report.hpp"
#include "protocol/scene/cells.hpp"

namespace ligature::regress {
namespace {

constexpr int kDigits = 9;
constexpr double kSame = 1e-8;  // relative: what nine digits leave open
constexpr const char* kHeader = "scene,figure,expected,tolerance";
// A figure's name may contain a comma, so the last two cells of a line are the numbers and the first one is the scene.
constexpr std::size_t kLeastCells = 4;

Verdict verdict_on(double value, const Expectation& expected) {
  if (!std::isfinite(value)) return Verdict::kBeyond;
  const double off = std::abs(value - expected.value);
  if (off <= kSame * std::max(std::abs(expected.value), 1e-3)) return Verdict::kSame;
  return off <= expected.tolerance ? Verdict::kMoved : Verdict::kBeyond;
}

}  // namespace

const char* name(Verdict verdict) noexcept {
  switch (verdict) {
    case Verdict::kSame:
      return "same";
    case Verdict::kMoved:
      return "moved";
    case Verdict::kBeyond:
      return "BEYOND";
    case Verdict::kNew:
      return "NEW";
    case Verdict::kGone:
      return "GONE";
  }
  return "";
}

Expectations read_expected(const std::string& text, const std::string& name) {
  Expectations all;
  std::stringstream lines(text);
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    if (line.empty() || line.starts_with('#') || line == kHeader) continue;
    const auto cells = scene::split(line);
    Expectation e;
    const bool good = cells.size() >= kLeastCells && scene::parse_number(cells[cells.size() - 2], e.value) &&
                      scene::parse_number(cells.back(), e.tolerance) && e.tolerance >= 0.0;
    if (!good)
      throw lab::Refusal(name + ":" + std::to_string(number) + ": found '" + line + "', allowed " + kHeader +
                         " with a tolerance of 0 or more");
    const std::string scene(cells.front());
    const auto from = line.find(',') + 1, to = line.rfind(',', line.rfind(',') - 1);
    if (!all.try_emplace({scene, line.substr(from, to - from)}, e).second)
      throw lab::Refusal(name + ":" + std::to_string(number) + ": found a figure for the second time");
  }
  return all;
}

std::vector<Line> compare(const Measured& measured, const Expectations& expected) {
  std::vector<Line> lines;
  for (const auto& [scene, figures] : measured) {
    for (const auto& f : figures) {
      const auto known = expected.find({scene, f.name});
      if (known == expected.end()) {
        lines.push_back({scene, f.name, {std::nan(""), f.tolerance}, f.value, Verdict::kNew});
      } else {
        lines.push_back({scene, f.name, known->second, f.value, verdict_on(f.value, known->second)});
      }
    }
    for (const auto& [key, e] : expected) {
      const auto is_it = [&](const Figure& f) { return f.name == key.second; };
      if (key.first == scene && std::none_of(figures.begin(), figures.end(), is_it))
        lines.push_back({scene, key.second, e, std::nan(""), Verdict::kGone});
    }
  }
  return lines;
}

std::string write_expected(const Measured& measured, const Expectations& before) {
  std::string text =
      "# What `ligature-lab regress` expects. Tolerances are in the unit of the figure, and may be edited.\n";
  text += std::string(kHeader) + "\n";
  for (const auto& [scene, figures] : measured) {
    for (const auto& f : figures) {
      const auto known = before.find({scene, f.name});
      const double tolerance = known == before.end() ? f.tolerance : known->second.tolerance;
      text += scene + "," + f.name + "," + lab::digits(f.value, kDigits) + "," + lab::digits(tolerance, kDigits) + "\n";
    }
  }
  return text;
}

}  // namespace ligature::regress
