#include "host/lab/experiment_command.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>

#include "host/console/stop_signal.hpp"
#include "host/lab/experiments/experiment.hpp"
#include "host/lab/option_checks.hpp"
#include "host/lab/outcome.hpp"
#include "host/lab/run_files.hpp"
#include "host/lab/scenes_folder.hpp"
#include "host/lab/validate/proceed.hpp"

namespace ligature::lab {
namespace {

struct Entry {
  const char* name;
  int (*run)(const Bench&);
};

constexpr Entry kExperiments[] = {{"models", experiment_models},       {"knotting", experiment_knotting},
                                  {"pulling", experiment_pulling},     {"unknotting", experiment_unknotting},
                                  {"stability", experiment_stability}, {"haptics", experiment_haptics}};

constexpr const char* kFooter = R"(
Each experiment of the paper gives a table (CSV, printed), a picture (PNG) and a verdict: one PASS or FAIL line a claim,
with the number that decides it. A picture needs the Python that scripts/setup installs (or $LIGATURE_PYTHON).
  models      the five models of Table II: what bends, rings, orbits, stretches
  knotting    trefoil and figure-eight tied by two hands, mirrored, released, ten seconds later
  pulling     one-hand and two-hand pulls, force per haptic frame, the paper's conditions A, B, C
  unknotting  a figure-eight on the desk undone by the right node and jammed by a wrong one; which pulls untie; a planner
  stability   the largest stable step of every model
  haptics     which walls the loop renders, energy at the ports, force fidelity, velocity noise; firmware code in the loop
  all         one after another

Exit: 0 all claims hold; 2 usage or scenes refused; 3 a claim fails; 130 interrupted: only what was finished before is
written.

Example
  ligature-lab experiment knotting --out out/knotting)";

struct Arguments {
  std::string name = "all";
  std::string out;
  std::string scenes;
};

int execute(const Arguments& a, const std::vector<Entry>& entries) {
  const Bench bench{find_scenes(a.scenes), a.out};
  make_folder(bench.out);
  validate::stop_asked = console::stop_requested;
  int worst = kDone;
  for (const auto& entry : entries) {
    try {
      worst = std::max(worst, entry.run(bench));
      validate::heed_stop();  // a signal may have ended the drawing of a picture alone
    } catch (const validate::Interrupted&) {
      throw Refusal(std::string(entry.name) + ": interrupted; " + a.out + " has what was finished before",
                    kInterrupted);
    }
  }
  return worst;
}

void add_folders(CLI::App& app, Arguments& a, const std::string& out) {
  a.out = out;
  app.add_option("--out", a.out, "Folder for tables and pictures")
      ->type_name("DIR")
      ->check(not_empty)
      ->capture_default_str();
  app.add_option("--scenes", a.scenes, "Folder of scenes [./scenes, else the installed one]")
      ->type_name("DIR")
      ->check(not_empty);
}

void add_alone(CLI::App& app, int& exit_code, Entry entry, const char* about, const std::string& more) {
  auto a = std::make_shared<Arguments>();
  auto* command = app.add_subcommand(entry.name, about);
  add_folders(*command, *a, std::string("out/") + entry.name);
  command->footer(
      more +
      "\nDIR holds the tables (CSV, also printed), their pictures (PNG) and the verdict: a PASS or FAIL line a "
      "claim.\n\nExit: 0 all claims hold; 2 usage or scenes refused; 3 a claim fails; 130 interrupted.\n\nExample\n  "
      "ligature-lab " +
      entry.name + " --out out/" + entry.name);
  command->callback([a, entry, &exit_code] { exit_code = execute(*a, {entry}); });
}

}  // namespace

void add_experiment_commands(CLI::App& app, int& exit_code) {
  auto a = std::make_shared<Arguments>();
  auto* command = app.add_subcommand("experiment", "The paper's experiments: table, picture, verdict");
  std::vector<std::string> names{"all"};
  for (const auto& e : kExperiments) names.emplace_back(e.name);
  command->add_option("name", a->name, "models, knotting, pulling, unknotting, stability, haptics or all")
      ->required()
      ->check(CLI::IsMember(names));
  add_folders(*command, *a, "out/experiment");
  command->footer(kFooter);
  command->callback([a, &exit_code] {
    std::vector<Entry> chosen;
    for (const auto& e : kExperiments) {
      if (a->name == "all" || a->name == e.name) chosen.push_back(e);
    }
    exit_code = execute(*a, chosen);
  });
  add_alone(app, exit_code, {"stability", experiment_stability}, "The largest stable step of every model",
            "The paper's models swing from level for 20 s at growing steps, with dampers as shipped and as printed.");
  add_alone(
      app, exit_code, {"extremes", experiment_extremes},
      "A map of what stays finite, over twelve decades of parameters",
      "Paper-4 and the rod with parameters, steps, shapes and hands far out of range. Each trial ends finite, stopped\n"
      "with tick and node named, or refused; that no number leaks out which is not finite is the claim.");
  add_alone(app, exit_code, {"bench", experiment_cost}, "What a tick costs, N = 20 .. 1000",
            "Paper-4, free and coiled up in contact; CPU time of the thread a tick: median, p99, worst.");
}

}  // namespace ligature::lab
