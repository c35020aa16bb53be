#include "host/lab/published/published_command.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>

#include "host/console/progress.hpp"
#include "host/console/stop_signal.hpp"
#include "host/lab/outcome.hpp"
#include "host/lab/published/case.hpp"
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
difference between the two is what the rig's speed costs. docs/measurements/published.md explains every case.

DIR gets published.csv, the table; CASE.csv, the points of the picture; and CASE.png, theory and measurement in one
plot. A picture needs the Python that scripts/setup installs (or $LIGATURE_PYTHON).

Cases
)";

constexpr const char* kExamples = R"(
Exit: 0 every judged figure is within its tolerance; 2 usage; 3 a case misses, or was interrupted.

Examples
  ligature-lab published                                  all cases, at balanced and at fine
  ligature-lab published capstan --quick
  ligature-lab published capstan --settings fine --out out/published)";

struct Arguments {
  std::vector<std::string> cases;
  std::string settings = "both";
  std::string out;
  bool quick = false;
};

struct Outcome {
  const p::Case* examined;
  std::string setting;
  p::Result result;
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

std::vector<std::pair<std::string, scene::Accuracy>> settings_of(const std::string& text) {
  std::vector<std::pair<std::string, scene::Accuracy>> all;
  if (text != "fine") all.emplace_back("balanced", scene::Accuracy::kBalanced);
  if (text != "balanced") all.emplace_back("fine", scene::Accuracy::kFine);
  return all;
}

p::Result measure(const p::Case& c, const p::Subject& subject) {
  try {
    return c.measure(subject);
  } catch (const validate::Interrupted&) {
    throw Refusal("published: interrupted in " + std::string(c.name) + ", nothing written", kRunFailed);
  }
}

void write_files(const std::filesystem::path& out, const std::vector<Outcome>& outcomes) {
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

void draw_case(const std::filesystem::path& out, const p::Case& c, const std::vector<Outcome>& outcomes) {
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
  const auto settings = settings_of(a.settings);
  if (!a.out.empty()) make_folder(a.out);
  validate::stop_asked = console::stop_requested;
  std::vector<Outcome> outcomes;
  Table table({"case", "setting", "figure", "expected", "measured", "tolerance", "verdict", "source"});
  int judged = 0, missed = 0;
  {
    console::Progress progress("published");
    double done = 0.0;
    for (const auto* c : cases) {
      for (const auto& [name, accuracy] : settings) {
        progress.show(done++ / static_cast<double>(cases.size() * settings.size()), std::string(c->name) + ", " + name);
        outcomes.push_back({c, name, measure(*c, {accuracy, a.quick})});
        for (const auto& f : outcomes.back().result.findings) {
          judged += p::is_judged(f), missed += !f.holds();
          table.row({std::string(c->name), name, f.what, value_or_dash(f.reference), value_or_dash(f.measured),
                     tolerance_text(f), std::string(verdict_of(f)), std::string(c->source)});
        }
      }
    }
  }
  table.print();
  std::printf("%d judged, %d missed\n", judged, missed);
  if (!a.out.empty()) {
    write_files(a.out, outcomes);
    for (const auto* c : cases) draw_case(a.out, *c, outcomes);
    std::printf("table %s/published.csv\n", a.out.c_str());
  }
  return missed == 0 ? kDone : kRunFailed;
}

}  // namespace

void add_published_command(CLI::App& app, int& exit_code) {
  auto a = std::make_shared<Arguments>();
  auto* command = app.add_subcommand("published", "The rod against experiments that others published");
  command->add_option("case", a->cases, "Names of cases [all]")->type_name("CASE");
  command->add_option("--settings", a->settings, "balanced, fine or both")
      ->check(CLI::IsMember({"balanced", "fine", "both"}))
      ->capture_default_str();
  command->add_option("--out", a->out, "Folder for table, points and pictures")->type_name("DIR");
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
