// What each number of the rod (firmware/physics/rod/tuning.hpp) is good for: the panel (panel.hpp) is run with the
// number halved and doubled, or with values that switch its rule off. Arguments and columns: rod_ablate --help.
//
// Rounding decides how a pull of two throws goes. So the panel is also run with one number changed by some 1e-9 of its
// value, and a difference counts if it exceeds three times the standard deviation of these runs.

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "firmware/physics/rod/tuning.hpp"
#include "tests/bench/rod/panel.hpp"

using namespace ligature::bench;
using ligature::physics::rod::Tuning;
using ligature::physics::rod::tuning;

namespace {

struct Number {
  const char* name;
  std::variant<double Tuning::*, int Tuning::*, long Tuning::*> at;
  std::vector<double> values;  ///< empty: half and double

  [[nodiscard]] double get() const {
    return std::visit([](auto member) { return static_cast<double>(tuning.*member); }, at);
  }
  void set(double value) const {
    if (const auto* real = std::get_if<0>(&at)) tuning.** real = value;
    if (const auto* whole = std::get_if<1>(&at)) tuning.** whole = static_cast<int>(value);
    if (const auto* large = std::get_if<2>(&at)) tuning.** large = static_cast<long>(value);
  }
};

#define NUMBER(name, ...)                 \
  {                                       \
#name, &Tuning::name, { __VA_ARGS__ } \
  }
const std::vector<Number> kNumbers = {
    NUMBER(near_d),
    NUMBER(skin_d),
    NUMBER(place_d, 0.0, 0.25, 0.8),
    NUMBER(place_stays_d, 0.0, 0.01),
    NUMBER(touch_lag, 1e-9, 0.02, 0.2),
    NUMBER(contact_N_per_m),
    NUMBER(recovery),
    NUMBER(most_cut_d, 0.175, 0.45),
    NUMBER(settled_m_per_s),
    NUMBER(settled_share, 0.0, 0.002, 0.008),
    NUMBER(stir, 0.0, 0.3),
    NUMBER(creep, 0.05, 1e9),
    NUMBER(newton_near, 1.0, 6.0),
    NUMBER(stale, 1, 100),
    NUMBER(moved, 0.05, 0.5),
    NUMBER(proximal, 0.0, 5e-4, 2e-3),
    NUMBER(work),
    NUMBER(substeps, 10, 12, 24),
    NUMBER(fewest_substeps, 6, 13, 100),
    NUMBER(labours, 0.1, 0.4, 1e9),
    NUMBER(patience, 0, 3, 48),
    NUMBER(turn_rad),
    NUMBER(start_turn_rad),
    NUMBER(bend_length),
    NUMBER(grading, 0.1, 0.4),
    NUMBER(fade, 0.64, 0.9),
    NUMBER(away),
    NUMBER(fade_share, 0.25, 1.0),
    NUMBER(first, 0.5, 1.0),
    NUMBER(worth, 1.2, 2.0),
};
#undef NUMBER

void print(const char* name, const Score& s) {
  std::printf("%-34s", name);
  for (std::size_t k = 0; k < kMeasures; ++k) std::printf(" %8.*f", k <= kGuard ? 0 : 3, s[k]);
}

/// Numbers that are changed together, and the name of the row.
struct Variant {
  std::string name;
  std::vector<std::pair<const Number*, double>> to;

  void add(const Number& number, double value) {
    char text[64];
    std::snprintf(text, sizeof text, "%s %g -> %g", number.name, number.get(), value);
    name += (name.empty() ? "" : ", ") + std::string(text);
    to.emplace_back(&number, value);
  }
  [[nodiscard]] Score run(const std::vector<Case>& cases) const {
    std::vector<double> before;
    for (const auto& [number, value] : to) before.push_back(number->get()), number->set(value);
    const Score s = ligature::bench::run(cases);
    for (std::size_t k = 0; k < to.size(); ++k) to[k].first->set(before[k]);
    return s;
  }
};

std::vector<Variant> variants_of(const Number& n) {
  std::vector<Variant> all;
  for (const double value : n.values.empty() ? std::vector<double>{0.5 * n.get(), 2.0 * n.get()} : n.values)
    all.emplace_back().add(n, value);
  return all;
}

/// Variants of an argument: NAME, or NAME=VALUE,NAME=VALUE.. for one variant. @throw std::invalid_argument
std::vector<Variant> variants_of(const std::string& text) {
  Variant together;
  std::istringstream parts(text);
  for (std::string part; std::getline(parts, part, ',');) {
    const std::string name = part.substr(0, part.find('='));
    const auto n = std::find_if(kNumbers.begin(), kNumbers.end(), [&](const Number& x) { return x.name == name; });
    if (n == kNumbers.end()) throw std::invalid_argument("found \"" + name + "\", no number of tuning.hpp");
    if (part == text && part == name) return variants_of(*n);
    if (part == name) throw std::invalid_argument("found \"" + part + "\", numbers changed together need values");
    const std::string value = part.substr(name.size() + 1);
    char* end = nullptr;
    const double to = std::strtod(value.c_str(), &end);
    if (value.empty() || *end != '\0') throw std::invalid_argument("found \"" + part + "\", needs NAME=VALUE");
    together.add(*n, to);
  }
  return {together};
}

/// Runs the panel with changes so small that only rounding differs. @return mean and standard deviation of each
/// measure.
std::pair<Score, Score> noise(const std::vector<Case>& cases, int runs) {
  std::vector<Score> all;
  Score mean{}, deviation{};
  const double stiffness = tuning.contact_N_per_m;
  for (int k = 0; k < runs; ++k) {
    tuning.contact_N_per_m = stiffness * (1.0 + 1e-9 * k);
    all.push_back(run(cases));
    for (std::size_t j = 0; j < kMeasures; ++j) mean[j] += all.back()[j] / runs;
    print(k == 0 ? "as it is" : "rounding", all.back());
    std::printf("\n");
    std::fflush(stdout);
  }
  tuning.contact_N_per_m = stiffness;
  for (std::size_t j = 0; j < kMeasures; ++j) {
    for (const auto& one : all) deviation[j] += std::pow(one[j] - mean[j], 2) / std::max(1, runs - 1);
    deviation[j] = std::sqrt(deviation[j]);
  }
  return {mean, deviation};
}

/// The measures that differ by more than the effect of rounding, and by more than 2 % of their mean.
std::string differs(const Score& s, const Score& mean, const Score& deviation) {
  std::string all;
  for (std::size_t k = 0; k < kMeasures; ++k) {
    const double by = s[k] - mean[k];
    if (std::abs(by) <= std::max(3.0 * deviation[k], 0.02 * std::abs(mean[k])) || by == 0.0) continue;
    char text[64];
    std::snprintf(text, sizeof text, " %s%+.3g", kColumns[k].name, by);
    all += text;
  }
  return all.empty() ? " -" : all;
}

}  // namespace

int main(int argc, char** argv) {
  std::uint64_t seed = 40321;
  int runs = 6;
  bool each = false, quick = false;
  std::string word;
  std::vector<std::string> only;
  CLI::App app("What each number of the rod is good for", "rod_ablate");
  std::string footer = "\nColumns:\n";
  for (const auto& c : kColumns) footer += std::string("  ") + c.name + "  " + c.meaning + "\n";
  app.footer(footer +
             "A mean over the cases, except wrong and guard. After each row: the measures that differ\n"
             "from the first rows by more than three standard deviations of rounding and by 2 %. Exit 0, or 2 for\n"
             "bad input.\n\nExample\n  rod_ablate near_d patience --seed 7");
  app.add_option("NUMBER", only,
                 "names of tuning.hpp, or NAME=VALUE,NAME=VALUE.. to change some together; default: all");
  app.add_option("--seed", seed, "draws speeds, forces and frictions");
  app.add_option("--rounding", runs, "runs that only rounding tells apart")->check(CLI::Range(1, 100));
  app.add_flag("--quick", quick, "every third case of the panel");
  app.add_option("--with", word, "only the cases with this word in their names, such as desk");
  app.add_flag("--cases", each, "prints every case as it is, and ends");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  std::vector<Variant> variants;
  const auto add = [&](const std::vector<Variant>& some) { variants.insert(variants.end(), some.begin(), some.end()); };
  try {
    for (const auto& text : only) add(variants_of(text));
  } catch (const std::invalid_argument& error) {
    return std::fprintf(stderr, "%s: %s\n", argv[0], error.what()), 2;
  }
  if (only.empty()) {
    for (const auto& n : kNumbers) add(variants_of(n));
  }
  auto cases = panel(seed);
  if (quick) {
    std::size_t k = 0;
    std::erase_if(cases, [&](const Case&) { return k++ % 3 != 0; });
  }
  std::erase_if(cases, [&](const Case& one) { return one.name.find(word) == std::string::npos; });
  std::printf("%-34s", "");
  for (const auto& c : kColumns) std::printf(" %8s", c.name);
  std::printf("\n");
  if (each) {
    for (const auto& one : cases) {
      print(one.name.c_str(), run(one));
      std::printf("   %.3f m/s\n", one.pull.speed_m_per_s);
    }
    return 0;
  }
  const auto [mean, deviation] = noise(cases, runs);
  print("deviation", deviation);
  std::printf("\n");
  for (const auto& variant : variants) {
    const Score s = variant.run(cases);
    print(variant.name.c_str(), s);
    std::printf(" %s\n", differs(s, mean, deviation).c_str());
    std::fflush(stdout);
  }
  return 0;
}
