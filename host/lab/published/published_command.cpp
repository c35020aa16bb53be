#include "host/lab/published/published_command.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>

#include "host/console/progress.hpp"
#include "host/console/stop_signal.hpp"
#include "host/lab/cpu_time.hpp"
#include "host/lab/option_checks.hpp"
#include "host/lab/outcome.hpp"
#include "host/lab/published/front.hpp"
#include "host/lab/report.hpp"
#include "host/lab/run_files.hpp"
#include "host/lab/validate/proceed.hpp"

namespace ligature::lab {
namespace {

namespace p = ligature::published;

constexpr const char* kFooter = R"(
Each case repeats an experiment that a laboratory, or the author of another program, has published. A row of the table
has the published value, the simulated one, the tolerance and the verdict: PASS, MISS, or "reported" where no published
number decides. `balanced` is the setting of the rig at 1 kHz, `fine` has smaller steps and no limit of time: the
difference between the two is what the rig's speed costs. --work adds settings between them: `balanced` with another
budget for contact. A second table has this cost, the CPU time of a tick, and what it buys: the largest error of a
case, as a multiple of its tolerance (inf: a yes-or-no figure misses). A third one sums up each setting over all cases:
mean cost, and figures missed; `pareto --published DIR` draws it beside its own fronts. docs/measurements/published.md
explains every case.

DIR gets published.csv and front.csv, the two tables; front.png, cost against error; CASE.csv, the points of a case's
picture; and CASE.png, theory and measurement in one plot. A picture needs the Python that scripts/setup installs (or
$LIGATURE_PYTHON).

Cases
)";

constexpr const char* kExamples = R"(
Exit: 0 every judged figure is within its tolerance; 2 usage; 3 a case misses; 130 interrupted: the
cases before are printed and written.

Examples
  ligature-lab published                                  all cases, at balanced and at fine
  ligature-lab published capstan --quick
  ligature-lab published capstan --settings fine --out out/published
  ligature-lab published capstan-axis --settings all --work 10e6 --work 20e6     what more work buys)";

struct Arguments {
  std::vector<std::string> cases;
  std::string settings = "both";
  std::vector<double> work;
  std::string out;
  bool quick = false;
};

const char* verdict_of(const p::Finding& f) { return !f.holds() ? "MISS" : p::is_judged(f) ? "PASS" : "reported"; }

/// Text of a value that may be absent.
std::string value_or_dash(double value) { return std::isnan(value) ? "-" : digits(value, 5); }

std::string tolerance_text(const p::Finding& f) {
  if (!p::is_judged(f)) return "-";
  if (f.unit == "relative") return digits(100.0 * f.tolerance) + " %";
  return f.unit == "outside" ? "in range" : digits(f.tolerance) + " " + f.unit;
}

std::string names_of_cases() {
  std::string names;
  for (const auto& c : p::all_cases()) names += (names.empty() ? "" : ", ") + std::string(c.name);
  return names;
}

std::vector<const p::Case*> chosen(const std::vector<std::string>& names) {
  std::vector<const p::Case*> all;
  for (const auto& name : names) {
    const auto known = p::all_cases();
    if (std::none_of(known.begin(), known.end(), [&](const p::Case& c) { return name == c.name; }))
      throw Refusal("published: found case " + name + ", allowed " + names_of_cases());
  }
  for (const auto& c : p::all_cases()) {
    if (names.empty() || std::find(names.begin(), names.end(), c.name) != names.end()) all.push_back(&c);
  }
  return all;
}

p::Outcome measure(const p::Case& c, const p::Setting& setting, bool quick) {
  const auto ticks = validate::ticks_done;
  const double begun_us = thread_cpu_us();
  auto result = c.measure({setting.accuracy, quick, setting.work});
  return {&c, setting.name, std::move(result), validate::ticks_done - ticks, thread_cpu_us() - begun_us};
}

/// Measures each case at each setting, and prints a line after each.
/// @return the case that was interrupted, or an empty text. `outcomes` has what was measured before.
std::string measure_all(const std::vector<const p::Case*>& cases, const std::vector<p::Setting>& settings, bool quick,
                        std::vector<p::Outcome>& outcomes) {
  const auto start = console::Progress::Clock::now();
  const auto whole = static_cast<double>(cases.size() * settings.size());
  for (const auto* c : cases) {
    for (const auto& setting : settings) {
      const std::string step = std::string(c->name) + ", " + setting.name;
      try {
        console::Progress progress("published", start);  // its end erases its line, before the next line is printed
        progress.show(static_cast<double>(outcomes.size()) / whole, step);
        outcomes.push_back(measure(*c, setting, quick));
      } catch (const validate::Interrupted&) {
        return step;
      }
      std::printf("%s: %d judged, %d missed\n", step.c_str(), outcomes.back().judged(), outcomes.back().missed());
      std::fflush(stdout);
    }
  }
  return {};
}

void print_table(const std::vector<p::Outcome>& outcomes) {
  Table table({"case", "setting", "figure", "expected", "measured", "tolerance", "verdict", "source"});
  for (const auto& o : outcomes) {
    for (const auto& f : o.result.findings) {
      table.row({std::string(o.examined->name), o.setting, f.what, value_or_dash(f.reference),
                 value_or_dash(f.measured), tolerance_text(f), std::string(verdict_of(f)),
                 std::string(o.examined->source)});
    }
  }
  table.print();
}

void write_files(const std::filesystem::path& out, const std::vector<p::Outcome>& outcomes) {
  Table csv({"case", "setting", "what", "expected", "measured", "error", "tolerance", "unit", "verdict", "source"});
  for (const auto& o : outcomes) {
    for (const auto& f : o.result.findings) {
      csv.row({std::string(o.examined->name), o.setting, f.what, value_or_dash(f.reference), f.measured, f.error,
               p::is_judged(f) ? Cell(f.tolerance) : Cell(std::string("-")), f.unit, std::string(verdict_of(f)),
               std::string(o.examined->source)});
    }
  }
  csv.write(out / "published.csv");
}

void draw_case(const std::filesystem::path& out, const p::Case& c, const std::vector<p::Outcome>& outcomes) {
  Table points({"curve", "setting", "x", "theory", "measured", "x_axis", "y_axis", "title"});
  for (const auto& o : outcomes) {
    if (o.examined != &c) continue;
    for (const auto& at : o.result.points) {
      points.row({at.curve, o.setting, at.x, at.theory, at.measured, std::string(c.x_axis), std::string(c.y_axis),
                  std::string(c.name) + ": " + c.source});
    }
  }
  points.write(out / (std::string(c.name) + ".csv"));
  draw("published.py", {out / (std::string(c.name) + ".csv")}, out / (std::string(c.name) + ".png"));
}

int execute(const Arguments& a) {
  const auto cases = chosen(a.cases);
  const auto settings = p::settings_of(a.settings, {a.work.begin(), a.work.end()});
  if (!a.out.empty()) make_folder(a.out);
  validate::stop_asked = console::stop_requested;
  std::vector<p::Outcome> outcomes;
  const std::string interrupted = measure_all(cases, settings, a.quick, outcomes);
  if (outcomes.empty()) throw Refusal("published: interrupted in " + interrupted + ", nothing measured", kInterrupted);
  int judged = 0, missed = 0;
  for (const auto& o : outcomes) judged += o.judged(), missed += o.missed();
  print_table(outcomes);
  const auto rows = p::front_of(outcomes);
  p::print_front(rows);
  if (settings.size() > 1) p::print_overall(p::over_all_cases(rows));
  std::printf("%d judged, %d missed\n", judged, missed);
  if (!a.out.empty()) {
    write_files(a.out, outcomes);
    p::write_front(a.out, rows);
    for (const auto* c : cases)
      if (std::ranges::any_of(outcomes, [c](const p::Outcome& o) { return o.examined == c; }))
        draw_case(a.out, *c, outcomes);
    std::printf("table %s/published.csv\n", a.out.c_str());
  }
  if (!interrupted.empty()) {
    std::fprintf(stderr, "published: interrupted in %s; what was measured before is above\n", interrupted.c_str());
    return kInterrupted;
  }
  return missed == 0 ? kDone : kRunFailed;
}

}  // namespace

void add_published_command(CLI::App& app, int& exit_code) {
  auto a = std::make_shared<Arguments>();
  auto* command = app.add_subcommand("published", "The rod against experiments that others published");
  command->add_option("case", a->cases, "Names of cases [all]")->type_name("CASE");
  command->add_option("--settings", a->settings, "balanced, fine, both, or all: fast too")
      ->check(CLI::IsMember({"balanced", "fine", "both", "all"}))
      ->capture_default_str();
  command
      ->add_option(
          "--work", a->work,
          "Also balanced with this budget for contact, instructions a tick: suture.work_instructions; repeatable")
      ->type_name("N")
      ->expected(1)
      ->check(within(1e5, 1e9))
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  command->add_option("--out", a->out, "Folder for table, points and pictures")->type_name("DIR")->check(not_empty);
  command->add_flag("--quick", a->quick, "The short form of each case, which the tests run");
  std::string footer = kFooter;
  for (const auto& c : p::all_cases()) {
    std::string name = c.name;
    name.resize(std::max<std::size_t>(16, name.size() + 1), ' ');
    footer += "  " + name + c.about + " (" + c.source + ")\n";
  }
  command->footer(footer + kExamples);
  command->callback([a, &exit_code] { exit_code = execute(*a); });
}

}  // namespace ligature::lab
