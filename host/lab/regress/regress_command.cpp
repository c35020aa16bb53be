#include "host/lab/regress/regress_command.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>

#include "host/console/progress.hpp"
#include "host/console/stop_signal.hpp"
#include "host/lab/option_checks.hpp"
#include "host/lab/outcome.hpp"
#include "host/lab/regress/expected.hpp"
#include "host/lab/report.hpp"
#include "host/lab/run_files.hpp"
#include "host/lab/scenes_folder.hpp"
#include "host/lab/validate/proceed.hpp"
#include "protocol/scene/text_file.hpp"

namespace ligature::lab {
namespace {

namespace r = ligature::regress;
namespace fs = std::filesystem;

constexpr const char* kFooter = R"(
Each scene is a short fixed run with figures and expected values. The same code gives the same figures to the bit, so
the table shows what a change to the physics has moved: "same", "moved" within its tolerance, or "BEYOND" it. The
expected values and tolerances are one file, host/lab/regress/expected.csv, built into the program.

Scenes
)";

constexpr const char* kExamples = R"(
Exit: 0 no figure beyond its tolerance; 2 usage; 3 a figure beyond it, new or gone; 130 interrupted.

Examples
  ligature-lab regress                                  all scenes
  ligature-lab regress --cheap --moved                  the fast scenes; only the lines that are not "same"
  ligature-lab regress square peg
  ligature-lab regress --update host/lab/regress/expected.csv --overwrite    accepts the present figures)";

struct Arguments {
  std::vector<std::string> scenes;
  std::string expected, update, folder;
  bool cheap = false, moved = false, overwrite = false;
};

std::vector<const r::RegressScene*> chosen(const Arguments& a) {
  const auto known = r::all_scenes();
  std::string names;
  for (const auto& s : known) names += (names.empty() ? "" : ", ") + std::string(s.name);
  for (const auto& name : a.scenes) {
    if (std::none_of(known.begin(), known.end(), [&](const r::RegressScene& s) { return name == s.name; }))
      throw Refusal("regress: found scene " + name + ", allowed " + names);
  }
  std::vector<const r::RegressScene*> all;
  for (const auto& s : known) {
    const bool named = a.scenes.empty() || std::find(a.scenes.begin(), a.scenes.end(), s.name) != a.scenes.end();
    if (named && (s.cheap || !a.cheap)) all.push_back(&s);
  }
  return all;
}

r::Expectations expected_of(const Arguments& a) {
  if (a.expected.empty()) return r::read_expected(r::embedded_expected(), "expected.csv");
  const auto read = scene::read_text(a.expected, scene::kMostCsv_bytes);
  if (const auto* error = std::get_if<scene::Error>(&read)) throw Refusal(error->text);
  return r::read_expected(std::get<std::string>(read), a.expected);
}

/// Refuses before anything is run. @return the file to write; empty: none.
fs::path check_update(const Arguments& a) {
  if (a.update.empty()) return {};
  if (a.cheap || !a.scenes.empty()) throw Refusal("--update: found a choice of scenes, allowed all scenes only");
  if (fs::exists(a.update) && !a.overwrite)
    throw Refusal("--update " + a.update + ": found a file of that name, allowed a new name, or --overwrite");
  return checked_file("--update", a.update);
}

/// Measures the scenes. @return the scene that was interrupted, or an empty text. `all` has those before it.
std::string measure(const std::vector<const r::RegressScene*>& scenes, const r::Bench& bench, r::Measured& all) {
  validate::stop_asked = console::stop_requested;
  console::Progress progress("regress");
  for (const auto* s : scenes) {
    progress.show(static_cast<double>(all.size()) / static_cast<double>(scenes.size()), s->name);
    try {
      all.emplace_back(s->name, s->measure(bench));
    } catch (const validate::Interrupted&) {
      return s->name;
    }
  }
  return {};
}

std::string value_or_dash(double value) { return std::isfinite(value) ? digits(value, 6) : "-"; }

/// Prints the table. @return the number of figures that are beyond their tolerance, new or gone.
int print(const std::vector<r::Line>& lines, bool moved_only) {
  Table table({"scene", "figure", "expected", "measured", "moved by", "tolerance", "verdict"});
  int same = 0, moved = 0, beyond = 0;
  for (const auto& line : lines) {
    const bool is_same = line.verdict == r::Verdict::kSame, is_moved = line.verdict == r::Verdict::kMoved;
    same += is_same, moved += is_moved, beyond += !is_same && !is_moved;
    if (is_same && moved_only) continue;
    table.row({line.scene, line.figure, value_or_dash(line.expected.value), value_or_dash(line.measured),
               is_same ? "0" : value_or_dash(line.measured - line.expected.value), digits(line.expected.tolerance),
               std::string(r::name(line.verdict))});
  }
  table.print();
  std::printf("%d figures: %d same, %d moved, %d beyond their tolerance, new or gone\n", static_cast<int>(lines.size()),
              same, moved, beyond);
  return beyond;
}

int execute(const Arguments& a) {
  const fs::path update = check_update(a);
  const auto scenes = chosen(a);
  const auto expected = expected_of(a);
  r::Measured measured;
  const std::string interrupted = measure(scenes, {find_scenes(a.folder)}, measured);
  if (!interrupted.empty() && (measured.empty() || !a.update.empty()))
    throw Refusal("regress: interrupted in " + interrupted + ", nothing written", kInterrupted);
  const int beyond = print(r::compare(measured, expected), a.moved);
  if (!interrupted.empty()) {
    std::fprintf(stderr, "regress: interrupted in %s; what was measured before is above\n", interrupted.c_str());
    return kInterrupted;
  }
  if (!a.update.empty()) {
    write_text(update, r::write_expected(measured, expected));
    std::printf("expected figures written to %s\n", a.update.c_str());
    return kDone;
  }
  return beyond == 0 ? kDone : kRunFailed;
}

}  // namespace

void add_regress_command(CLI::App& app, int& exit_code) {
  auto a = std::make_shared<Arguments>();
  auto* command =
      app.add_subcommand("regress", "What a change to the physics has moved: fixed scenes, expected figures");
  command->add_option("scene", a->scenes, "Names of scenes [all]")->type_name("SCENE");
  command->add_flag("--cheap", a->cheap, "Only the scenes that take less than about a second, which a test runs");
  command->add_flag("--moved", a->moved, "Print only the figures that are not the same");
  command->add_option("--expected", a->expected, "Compare with this file [built in]")
      ->type_name("FILE")
      ->check(not_empty);
  command->add_option("--update", a->update, "Write the measured figures to a file, with the tolerances as before")
      ->type_name("FILE")
      ->check(not_empty);
  command->add_flag("--overwrite", a->overwrite, "--update may replace an existing file");
  command->add_option("--scenes", a->folder, "Folder of scenes [./scenes, else the installed one]")
      ->type_name("DIR")
      ->check(not_empty);
  std::string footer = kFooter;
  for (const auto& s : r::all_scenes()) {
    std::string name = s.name;
    name.resize(std::max<std::size_t>(16, name.size() + 1), ' ');
    footer += "  " + name + s.about + "\n";
  }
  command->footer(footer + kExamples);
  command->callback([a, &exit_code] { exit_code = execute(*a); });
}

}  // namespace ligature::lab
