#include "host/lab/fit_command.hpp"

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <system_error>
#include <vector>

#include "host/lab/fit/fit.hpp"
#include "host/lab/option_checks.hpp"
#include "host/lab/outcome.hpp"
#include "host/lab/report.hpp"
#include "host/lab/run_files.hpp"

namespace ligature::lab {
namespace {

constexpr const char* kFooter = R"(
A file is a table of plain numbers in SI units; '#' begins a comment. Its header says what was measured. Give the files
in any order, several of one kind as well, each with 3 rows or more. What each kind is for, and its header:
)";

constexpr const char* kExamples = R"(
'sag' and 'swing' also need 'weigh'. 'swing' counts: `swings` full swings of a hanging thread of `length_m` take `time_s`,
in which the amplitude of its tip falls from `start_m` to `end_m`. Two different lengths separate the damping of bending
from the drag of the air. The table printed has each value with half its 95 % interval, and how far the rows lie from the
law. docs/materials.md has the recipe, step by step.

Exit: 0 done; 2 a file or an option refused; 3 no material explains the measurements, or a value was left out because no
scene takes it or the measurements hardly tell it.

Examples
  ligature-lab fit weigh.csv load.csv
  ligature-lab fit weigh.csv load.csv sag.csv swing.csv drag.csv --out thread.toml
  ligature-lab run scene.toml          with the lines of thread.toml copied into scene.toml)";

/// The lines of a scene that say what was found.
std::string toml_of(const fit::Fitted& fitted) {
  std::string text;
  for (const std::string table : {"suture", "contact"}) {
    std::string lines;
    for (std::size_t k = 0; k < fit::kParameters; ++k) {
      const auto& found = fitted.found[k];
      if (!found || fit::kTold[k].table != table) continue;
      lines += std::string(fit::kTold[k].name) + " = " + digits(found->value, fit::kDigits) + "   # +- " +
               digits(found->half_95, 2) + "\n";
    }
    if (lines.empty()) continue;
    text += (text.empty() ? "[" : "\n[") + table + "]\n" + (table == "suture" ? "model = \"rod\"\n" : "") + lines;
  }
  return text;
}

void print(const fit::Fitted& fitted) {
  Table found({"parameter", "value", "+- (95 %)", "unit"});
  for (std::size_t k = 0; k < fit::kParameters; ++k) {
    if (const auto& e = fitted.found[k]) {
      found.row({std::string(fit::kTold[k].name), digits(e->value, fit::kDigits), digits(e->half_95, 2),
                 std::string(*fit::kTold[k].unit ? fit::kTold[k].unit : "-")});
    }
  }
  found.print();
  std::printf("\n");
  Table misfits({"measured", "figure", "rows", "rms distance from the law"});
  for (const auto& m : fitted.misfits)
    misfits.row({std::string(m.law->name), std::string(m.figure), static_cast<double>(m.rows), digits(m.rms, 2)});
  misfits.print();
  const auto &EI = fitted.found[fit::kEI], &EA = fitted.found[fit::kEA];
  if (EI && EA) {
    std::printf(
        "\nA solid round rod with this EI and EA has the diameter %s mm: 4 sqrt(EI / EA). A smaller one than\n"
        "measured says that the thread is no solid rod; a braid bends more easily.\n",
        digits(4e3 * std::sqrt(EI->value / EA->value)).c_str());
  }
}

/// Checks the names before anything is read. @return the file to write; empty: none. @throws Refusal
std::filesystem::path checked_names(const std::vector<std::string>& files, const std::string& out) {
  namespace fs = std::filesystem;
  std::error_code none;
  const fs::path target = out.empty() ? fs::path() : checked_file("--out", out);
  for (std::size_t k = 0; k < files.size(); ++k) {
    if (!out.empty() && fs::equivalent(files[k], target, none))
      throw Refusal("--out " + out + ": is one of the measurements, allowed another name");
    for (std::size_t i = 0; i < k; ++i) {
      if (fs::equivalent(files[i], files[k], none)) throw Refusal(files[k] + ": is named twice, allowed once");
    }
  }
  return target;
}

int execute(const std::vector<std::string>& files, const std::string& out) {
  const auto target = checked_names(files, out);
  std::vector<fit::Measurement> all;
  all.reserve(files.size());
  for (const auto& file : files) all.push_back(fit::read_measurement(file));
  fit::check_enough(all);
  auto fitted = fit::fit(all);
  const auto left_out = fit::leave_out_impossible(fitted);
  print(fitted);
  if (const std::string text = toml_of(fitted); !out.empty() && !text.empty()) {
    write_text(target, text);
    std::printf("file %s\n", out.c_str());
  }
  for (const auto& line : left_out) std::fprintf(stderr, "ligature-lab: fit: left out %s\n", line.c_str());
  return left_out.empty() ? kDone : kRunFailed;
}

}  // namespace

void add_fit_command(CLI::App& app, int& exit_code) {
  auto* command = app.add_subcommand("fit", "EA, EI, friction and damping of a thread from a lab's own measurements");
  auto files = std::make_shared<std::vector<std::string>>();
  auto out = std::make_shared<std::string>();
  command->add_option("files", *files, "Measurements (CSV)")->required()->type_name("FILE.csv");
  command->add_option("--out", *out, "TOML file for the keys of a scene")->type_name("FILE")->check(not_empty);
  std::string footer = kFooter;
  for (const auto& law : fit::laws()) {
    std::string name = law.name;
    name.resize(8, ' ');
    footer += "  " + name + law.recipe + "\n          " + law.header + "\n";
  }
  command->footer(footer + kExamples);
  command->callback([files, out, &exit_code] { exit_code = execute(*files, *out); });
}

}  // namespace ligature::lab
