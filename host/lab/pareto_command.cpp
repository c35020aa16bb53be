#include "host/lab/pareto_command.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <map>
#include <memory>

#include "host/console/progress.hpp"
#include "host/console/stop_signal.hpp"
#include "host/lab/option_checks.hpp"
#include "host/lab/outcome.hpp"
#include "host/lab/pareto/instructions.hpp"
#include "host/lab/pareto/trials.hpp"
#include "host/lab/published/front.hpp"
#include "host/lab/report.hpp"
#include "host/lab/run_files.hpp"
#include "host/lab/validate/proceed.hpp"
#include "protocol/scene/scene_file.hpp"

namespace ligature::lab {
namespace {

constexpr const char* kFooter = R"(
Every model at N = 20 .. 500 with substeps and contact passes varied. For each setting:
  cost    thread-CPU microseconds a 1 ms tick while a loose overhand is pulled and held: median, p99, worst; for those
          on a front instructions too, where valgrind is there (p99 of 250 ticks is the third worst)
  errors  shape  worst static error of elastica and catenary (validate), of L (explicit models: to 50 nodes)
          swing  free end of a thread let go level, rms distance from the model's own finest setting, of L
          knot   distance between the hands in the hold, against the own finest, in diameters; empty: knot lost
DIR holds pareto.csv and pareto.png (cost against error, the fronts drawn, 1 kHz marked). The rod is the 0.3 mm suture,
the paper's models their 5 m thread; errors are relative to each model's own finest, so models are not compared with
each other but in cost. docs/measurements/accuracy.md says which setting to take for what.

--published adds a third front: what fast, balanced and fine cost and how many figures of published experiments they
miss, over all cases. DIR is the folder of an earlier run of `ligature-lab published`; several are taken together. DIR
of --out then holds pareto-published.csv too.

Examples
  ligature-lab pareto --out out/pareto --quick
  ligature-lab published --settings all --work 10e6 --out out/published
  ligature-lab pareto --out out/pareto --published out/published)";

struct Arguments {
  std::string out = "out/pareto";
  bool quick = false;
  std::string model;
  std::vector<std::string> published;
  std::string one;
  int ticks = 0;
};

struct Point {
  Setting setting;
  Spread us;
  Errors errors;
  double penetration = 0.0;
  std::string knot;
  std::optional<Spread> instructions;
  bool on_swing_front = false, on_knot_front = false;
};

/// Marks the Pareto front of each model: points that no other point of the model beats in cost and error.
template <class Error, class Mark>
void mark_front(std::vector<Point>& points, Error error, Mark mark) {
  for (auto& p : points) {
    if (std::isnan(error(p))) continue;
    const bool beaten = std::any_of(points.begin(), points.end(), [&](const Point& q) {
      return q.setting.model == p.setting.model && q.us.median <= p.us.median && error(q) <= error(p) &&
             (q.us.median < p.us.median || error(q) < error(p));
    });
    mark(p) = !beaten;
  }
}

/// Error drawn in the picture: the larger one of the errors of shape and swing. NaN when the shape error was not
/// measured (explicit models beyond 50 nodes), because the swing error alone would not be comparable.
double motion_error(const Point& p) {
  return std::isnan(p.errors.shape) ? p.errors.shape : std::fmax(p.errors.shape, p.errors.swing);
}

Cell optional_cell(bool there, double value) {
  if (!there) return std::string();
  return value;
}

void write(const std::vector<Point>& points, const std::filesystem::path& path) {
  Table t({"setting",
           "model",
           "nodes",
           "substeps",
           "passes",
           "preset",
           "median_us",
           "p99_us",
           "worst_us",
           "median_instructions",
           "p99_instructions",
           "worst_instructions",
           "shape_of_L",
           "swing_of_L",
           "motion_of_L",
           "knot_diameters",
           "penetration_diameters",
           "knot",
           "motion_front",
           "knot_front"});
  for (const auto& p : points) {
    const auto& s = p.setting;
    const bool counted = p.instructions.has_value(), kept = !std::isnan(p.errors.knot);
    const Spread n = p.instructions.value_or(Spread{});
    t.row({s.text(),
           std::string(scene::name(s.model)),
           double(s.nodes),
           double(s.substeps),
           double(s.passes),
           s.preset,
           p.us.median,
           p.us.p99,
           p.us.max,
           optional_cell(counted, n.median),
           optional_cell(counted, n.p99),
           optional_cell(counted, n.max),
           optional_cell(!std::isnan(p.errors.shape), p.errors.shape),
           p.errors.swing,
           optional_cell(!std::isnan(motion_error(p)), motion_error(p)),
           optional_cell(kept, p.errors.knot),
           p.penetration,
           p.knot,
           double(p.on_swing_front),
           double(p.on_knot_front)});
  }
  t.write(path);
}

void print_fronts(const std::vector<Point>& points) {
  Table t({"setting", "median us", "p99", "worst", "M instr. median", "worst", "shape % L", "swing % L", "knot d",
           "penetration d", "front"});
  for (const auto& p : points) {
    if (!p.on_swing_front && !p.on_knot_front && p.setting.preset.empty()) continue;
    const bool counted = p.instructions.has_value();
    const std::string front = std::string(p.on_swing_front ? "motion " : "") + (p.on_knot_front ? "knot" : "");
    t.row({p.setting.text(), p.us.median, p.us.p99, p.us.max,
           optional_cell(counted, 1e-6 * p.instructions.value_or(Spread{}).median),
           optional_cell(counted, 1e-6 * p.instructions.value_or(Spread{}).max),
           optional_cell(!std::isnan(p.errors.shape), 100.0 * p.errors.shape), 100.0 * p.errors.swing,
           optional_cell(!std::isnan(p.errors.knot), p.errors.knot), p.penetration, front});
  }
  t.print();
}

/// Runs the knot of one setting only; called under callgrind.
int run_one(const Arguments& a) {
  const auto traces = run_trials(setting_of(a.one), a.ticks);
  const auto us = spread_of(traces.us);
  std::printf("%s: %zu ticks, median %.1f us, p99 %.1f us, worst %.1f us, knot %s, penetration %.3f diameters\n",
              a.one.c_str(), traces.us.size(), us.median, us.p99, us.max,
              a.ticks > 0 ? "not looked at" : traces.knot.c_str(), traces.penetration);
  return kDone;
}

/// @return a point for each setting that was measured whole before the command was asked to stop
std::vector<Point> measure(const std::vector<Setting>& settings) {
  std::vector<Point> points;
  std::map<scene::Model, Traces> finest_of;
  console::Progress progress("pareto");
  for (std::size_t k = 0; k < settings.size(); ++k) {
    const auto& s = settings[k];
    progress.show(static_cast<double>(k) / static_cast<double>(settings.size()), s.text());
    try {
      if (!finest_of.contains(s.model)) finest_of[s.model] = run_trials(finest(s.model));
      const auto traces = run_trials(s);
      Point p{s, spread_of(traces.us), errors_of(s, traces, finest_of[s.model]), traces.penetration, traces.knot, {}};
      points.push_back(std::move(p));
    } catch (const validate::Interrupted&) {
      break;
    }
  }
  return points;
}

void count(std::vector<Point>& points) {
  console::Progress progress("pareto");
  bool there = true;
  double done = 0.0;
  for (auto& p : points) {
    progress.show(done++ / static_cast<double>(points.size()), "instructions, " + p.setting.text());
    if (!there || console::stop_requested()) break;
    if (!p.on_swing_front && !p.on_knot_front && p.setting.preset.empty()) continue;
    if (p.setting.nodes > 200) continue;  // takes minutes each
    p.instructions = count_instructions(p.setting, 250);
    there = p.instructions.has_value();
  }
  if (!there && !console::stop_requested()) std::printf("no instruction counts: valgrind could not be run\n");
}

int execute(const Arguments& a) {
  validate::stop_asked = console::stop_requested;
  if (!a.one.empty()) return run_one(a);
  auto settings = all_settings(a.quick);
  if (!a.model.empty()) {
    std::erase_if(settings, [&](const Setting& s) { return scene::name(s.model) != a.model; });
    if (settings.empty()) throw Refusal("--model: found " + a.model + ", allowed paper-1 .. paper-5, rod");
  }
  std::vector<published::FrontRow> rows;
  for (const auto& folder : a.published) std::ranges::move(published::read_front(folder), std::back_inserter(rows));
  make_folder(a.out);
  const std::filesystem::path out(a.out);
  auto points = measure(settings);
  if (points.empty()) throw Refusal("pareto: interrupted, nothing written", kInterrupted);
  mark_front(points, motion_error, [](Point& p) -> bool& { return p.on_swing_front; });
  mark_front(
      points, [](const Point& p) { return p.errors.knot; }, [](Point& p) -> bool& { return p.on_knot_front; });
  count(points);
  print_fronts(points);
  write(points, out / "pareto.csv");
  std::vector<std::filesystem::path> tables{out / "pareto.csv"};
  if (!rows.empty()) {
    const auto overall = published::over_all_cases(rows);
    published::print_overall(overall);
    published::write_overall(tables.emplace_back(out / "pareto-published.csv"), overall);
  }
  draw("pareto.py", tables, out / "pareto.png");
  if (console::stop_requested()) {
    std::fprintf(stderr, "pareto: interrupted after %zu of %zu settings\n", points.size(), settings.size());
    return kInterrupted;
  }
  return kDone;
}

}  // namespace

void add_pareto_command(CLI::App& app, int& exit_code) {
  auto a = std::make_shared<Arguments>();
  auto* command = app.add_subcommand("pareto", "What accuracy costs: every model, N, substeps, contact passes");
  command->add_option("--out", a->out, "Folder for pareto.csv and pareto.png")
      ->type_name("DIR")
      ->check(not_empty)
      ->capture_default_str();
  command->add_flag("--quick", a->quick, "About a sixth of the settings");
  command->add_option("--model", a->model, "This model alone: paper-1 .. paper-5 or rod [all]")
      ->type_name("MODEL")
      ->check(not_empty);
  command
      ->add_option("--published", a->published,
                   "Folder of a run of `ligature-lab published`: its front over all cases, too; repeatable")
      ->type_name("DIR")
      ->expected(1)
      ->check(not_empty)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  command->add_option("--one", a->one, "One setting's knot alone, MODEL/NODES/SUBSTEPS/PASSES or rod/NODES/PRESET")
      ->type_name("SETTING")
      ->check(not_empty);
  command->add_option("--ticks", a->ticks, "With --one: so many ticks [the whole pull and hold]")
      ->type_name("N")
      ->check(within(1, 1e6));
  command->footer(kFooter);
  command->callback([a, &exit_code] { exit_code = execute(*a); });
}

}  // namespace ligature::lab
