#include "host/lab/tie/tie_command.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <fstream>
#include <memory>

#include "host/console/progress.hpp"
#include "host/console/stop_signal.hpp"
#include "host/errors.hpp"
#include "host/lab/option_checks.hpp"
#include "host/lab/outcome.hpp"
#include "host/lab/rehearsal.hpp"
#include "host/lab/report.hpp"
#include "host/lab/run_files.hpp"
#include "host/lab/tie/recordings.hpp"
#include "host/lab/tie/tie_once.hpp"
#include "host/lab/validate/proceed.hpp"
#include "protocol/scene/recorded_scene.hpp"
#include "sim_device/operator/knot_tier.hpp"
#include "sim_device/operator/knots.hpp"

namespace ligature::lab {
namespace {

constexpr double kEnough = 0.95;
constexpr const char *kScene = "scenes/paper.toml", *kLongScene = "scenes/paper-long.toml";

struct Arguments {
  std::vector<std::string> knots;
  std::vector<std::string> models;
  std::string scene;
  std::vector<std::string> overrides;
  std::string seeds = "1-20";
  std::string out = "out/tie";
  std::string script_out;
  double script_within = 0.3;  // tolerance of the written script, in thread diameters
  bool force = false;
};

constexpr const char* kFooter = R"(
An operator who looks at the thread 100 times a second ties the knot with two simulated devices: encoder counts, CAN
frames, coupling, torque, all on a simulated clock. Each run's recording (DIR/KNOT-SEED.lcmlog, what `ligature-host
record` would have written) is read back, and the knot in its last shape, five seconds after the hands let go, counts.

Several knots or models end with a table.

--script-out writes what the hands wanted, without their tremor and within the arm's reach, as a script for
`ligature-device --operator`: it plays on a rig and does not look. `ligature-lab play` counts how often it ties.

DIR/results.csv has one row for each run that is finished, those of earlier calls included. Exit: 0 done; 2 knot, scene
or seeds refused; 3 fewer than 95 % tied of any knot in any model; 130 interrupted, what was finished is kept.

Examples:
  ligature-lab tie overhand figure-eight square granny surgeon --models paper-1,paper-4 --seeds 1-4
  ligature-lab tie overhand --scene scenes/suture-3-0.toml --seeds 1-20 --out out/tie
  ligature-lab tie square --scene scenes/suture-3-0.toml --seeds 7 --script-out square.csv)";

struct Count {
  int tied = 0, tried = 0;
  [[nodiscard]] bool is_enough() const { return tried > 0 && tied >= kEnough * tried; }
  [[nodiscard]] std::string text() const { return std::to_string(tied) + " of " + std::to_string(tried); }
};

/// Checks --script-out: a script can be written for one run only. @return the file to write. @throws Refusal
std::string checked_script_out(const Arguments& a, const Seeds& seeds) {
  if (a.script_out.empty()) return {};
  const auto runs = a.knots.size() * std::max<std::size_t>(1, a.models.size()) * (seeds.last - seeds.first + 1);
  if (runs != 1) throw Refusal("--script-out: found " + std::to_string(runs) + " runs, allowed one knot with one seed");
  if (!(a.script_within > 0.0 && a.script_within <= 10.0))
    throw Refusal("--script-within: found " + digits(a.script_within) + ", allowed more than 0, at most 10");
  return checked_file("--script-out", a.script_out).string();
}

/// One knot tied in one model.
struct Cell {
  std::string knot, model;  ///< model empty: the scene's own model
  std::string file, folder;
  scene::Scene scene;
  std::string toml;  // the scene's text for the recordings
};

/// @throws Refusal when the scene is refused or the knot cannot be tied in it; nothing has run or been written then.
Cell cell_of(const Arguments& a, const std::string& knot, const std::string& model) {
  if (!sim::knot_named(knot)) throw Refusal("knot: found \"" + knot + "\", allowed " + sim::knot_names());
  Cell c{knot, model, a.scene, model.empty() ? a.out : a.out + "/" + model, {}, {}};
  if (c.file.empty()) c.file = knot.starts_with("surgeon") ? kLongScene : kScene;
  auto overrides = a.overrides;
  if (!model.empty()) overrides.push_back("suture.model=\"" + model + "\"");
  const auto text = read_scene_text_or_refuse(c.file);
  c.scene = parse_scene_or_refuse(text, c.file, overrides);
  check_tick(c.scene, c.file);
  const auto thread = make_or_refuse(c.scene, c.file);
  c.toml = scene::recorded_text(text, overrides, c.scene);
  if (thread.work() > 0)
    c.toml += "\n# work " + std::to_string(thread.work()) + " instructions a tick, of hands at rest";
  const auto made = sim::KnotTier::make(c.scene, knot, 1);
  if (const auto* why = std::get_if<std::string>(&made)) throw Refusal(c.file + ": " + *why);
  return c;
}

void write_script(const Arguments& a, const Cell& c, std::uint32_t seed, const HandRecord& hands) {
  const double within_m = a.script_within * 2.0 * c.scene.suture.radius_m;
  const auto script = hands.script(within_m);
  std::string how = "ligature-lab tie " + c.knot + " --scene " + c.file;
  for (const auto& o : a.overrides) how += " --set " + o;
  how += " --seeds " + std::to_string(seed) + " --script-within " + digits(a.script_within) + " --script-out FILE";
  write_text(a.script_out, scene::gripper_script_text(script, how));
  std::printf("script: %zu keys in %s, within %s m of the hands\n", script.keys[0].size() + script.keys[1].size(),
              a.script_out.c_str(), digits(within_m).c_str());
}

std::string missed_in_one_cell(const Tied& t) {
  std::string cell;
  for (const auto& move : t.missed) cell += (cell.empty() ? "" : "; ") + move;
  return cell;
}

constexpr const char* kHeader = "model,knot,seed,found,seconds,tied,moves given up\n";

/// What results.csv of an earlier call says, without the rows that this call makes anew; else the header alone.
std::string rows_to_keep(const std::string& file, const std::vector<Cell>& cells, const Seeds& seeds) {
  std::ifstream earlier(file);
  std::string line, kept = kHeader;
  if (!std::getline(earlier, line) || line + "\n" != kHeader) return kept;
  const auto is_made_anew = [&](const Cell& c) {
    for (std::uint32_t seed = seeds.first; seed <= seeds.last; ++seed)
      if (line.starts_with(c.model + "," + c.knot + "," + std::to_string(seed) + ",")) return true;
    return false;
  };
  while (std::getline(earlier, line))
    if (std::ranges::none_of(cells, is_made_anew)) kept += line + "\n";
  return kept;
}

/// Ties the knot once per seed; prints a line and adds a row to results.csv for each.
Count tie_all(const Arguments& a, const Cell& c, const Seeds& seeds, std::string& results) {
  Count count;
  const auto began = console::Progress::Clock::now();
  std::printf("%6s  %-20s %8s  %s\n", "seed", "found", "seconds", "moves given up");
  for (std::uint32_t seed = seeds.first; seed <= seeds.last && !console::stop_requested(); ++seed) {
    HandRecord hands(sim::WorkspaceMap(c.scene.hands));
    Tied t;
    try {
      console::Progress progress("tie", began);  // erases its line before the row is printed
      progress.show(static_cast<double>(seed - seeds.first) / (seeds.last - seeds.first + 1.0),
                    c.knot + ", seed " + std::to_string(seed) + ", tied " + count.text());
      t = tie_once(c.scene, c.file, c.toml, c.knot, seed, recording_of(c.folder, c.knot, seed),
                   a.script_out.empty() ? nullptr : &hands);
    } catch (const validate::Interrupted&) {
      break;
    } catch (const host::RunFailed&) {
      if (!console::stop_requested()) throw;
      break;  // a signal also ends the reading of the recording
    }
    ++count.tried;
    count.tied += t.good();
    std::printf("%6u  %-20s %8.1f  %s\n", seed, t.found.c_str(), t.seconds, missed_in_one_cell(t).c_str());
    results += c.model + "," + c.knot + "," + std::to_string(seed) + "," + t.found + "," + digits(t.seconds) + "," +
               (t.good() ? "1," : "0,") + missed_in_one_cell(t) + "\n";
    write_text(a.out + "/results.csv", results);
    if (!a.script_out.empty() && t.good()) write_script(a, c, seed, hands);
    std::fflush(stdout);
  }
  std::printf("%s%s%s: tied %s\n", c.model.c_str(), c.model.empty() ? "" : " ", c.knot.c_str(), count.text().c_str());
  return count;
}

const char* model_name(const Arguments& a, std::size_t k) {
  return a.models[k].empty() ? "the scene's" : a.models[k].c_str();
}

/// Prints the table of successes: one line per model, one column per knot.
void print_table(const Arguments& a, const std::vector<Count>& counts) {
  std::printf("\n%-12s", "model");
  for (const auto& knot : a.knots) std::printf(" %14s", knot.c_str());
  for (std::size_t k = 0; k < counts.size(); ++k) {
    if (k % a.knots.size() == 0) std::printf("\n%-12s", model_name(a, k / a.knots.size()));
    std::printf(" %14s", counts[k].text().c_str());
  }
  std::printf("\n");
}

int execute(Arguments a) {
  const Seeds seeds = read_seeds(a.seeds);
  a.script_out = checked_script_out(a, seeds);
  if (a.models.empty()) a.models = {""};
  std::vector<Cell> cells;
  for (const auto& model : a.models)
    for (const auto& knot : a.knots) cells.push_back(cell_of(a, knot, model));
  for (const Cell& c : cells) check_free(c.folder, c.knot, seeds, a.force);
  check_outputs(a.out, {"results.csv"});
  for (const Cell& c : cells) make_folder(c.folder);
  validate::stop_asked = console::stop_requested;
  std::string results = rows_to_keep(a.out + "/results.csv", cells, seeds);
  std::vector<Count> counts;
  counts.reserve(cells.size());
  for (const Cell& c : cells) counts.push_back(tie_all(a, c, seeds, results));
  if (counts.size() > 1) print_table(a, counts);
  if (console::stop_requested()) return kInterrupted;
  return std::all_of(counts.begin(), counts.end(), [](const Count& c) { return c.is_enough(); }) ? kDone : kRunFailed;
}

}  // namespace

void add_tie_command(CLI::App& app, int& exit_code) {
  auto* tie = app.add_subcommand("tie", "Knots tied by an operator that looks, through the whole chain, and counted");
  auto a = std::make_shared<Arguments>();
  tie->add_option("knot", a->knots, "Which of " + sim::knot_names())->required();
  tie->add_option("--models", a->models, "Instead of the scene's own: paper-1,paper-2,...; recordings in DIR/MODEL")
      ->check(not_empty)
      ->delimiter(',');
  tie->add_option("--scene", a->scene, "Scene file (TOML); its node 0 must be fixed")
      ->check(not_empty)
      ->default_str("scenes/paper.toml; for surgeon scenes/paper-long.toml");
  tie->add_option("--set", a->overrides, "key=value over the scene's own; repeatable")
      ->type_name("KEY=VALUE")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  tie->add_option("--seeds", a->seeds, "N or FIRST-LAST: another operator each")->capture_default_str();
  tie->add_option("--out", a->out, "Folder for the recordings and results.csv, to which rows are added")
      ->type_name("DIR")
      ->check(not_empty)
      ->capture_default_str();
  tie->add_flag("--force", a->force, "Replace the recordings of an earlier call");
  tie->add_option("--script-out", a->script_out, "Of one run that ties: what the hands wanted, as a gripper script")
      ->type_name("FILE")
      ->check(not_empty);
  tie->add_option("--script-within", a->script_within, "How near the script comes to it, in diameters of the thread")
      ->capture_default_str();
  tie->footer(kFooter);
  tie->callback([a, &exit_code] { exit_code = execute(*a); });
}

}  // namespace ligature::lab
