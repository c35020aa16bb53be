#include "host/lab/tie/play_command.hpp"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>

#include "host/console/stop_signal.hpp"
#include "host/lab/option_checks.hpp"
#include "host/lab/outcome.hpp"
#include "host/lab/rehearsal.hpp"
#include "host/lab/report.hpp"
#include "host/lab/run_files.hpp"
#include "host/lab/tie/play_once.hpp"
#include "host/lab/tie/recordings.hpp"
#include "host/lab/tie/tie_once.hpp"
#include "host/lab/validate/proceed.hpp"
#include "protocol/scene/recorded_scene.hpp"
#include "sim_device/operator/knots.hpp"
#include "sim_device/script_hand.hpp"

namespace ligature::lab {
namespace {

struct Arguments {
  std::string script, scene, knot;
  std::vector<std::string> overrides;
  std::string seeds = "1-20", out;
  double least = 0.95;
  bool force = false;
  Trouble trouble;
};

constexpr const char* kFooter = R"(
A script does not look. Each seed plays it with other hands on another day: one hand begins later, both tremble, the
controller loses periods (the thread then stands still while the hands go on), and whatever else is asked for. What
counts is the knot in the thread five seconds after the last key. `ligature-lab tie --script-out` makes such scripts.

Exit: 0 done; 2 script, scene or options refused; 3 a share of less than --least is the knot asked for; 130 interrupted:
the seeds before are printed, and their recordings kept.

Examples:
  ligature-lab play square.csv --scene scenes/suture-3-0.toml --knot square --seeds 1-20
  ligature-lab play square.csv --scene scenes/suture-3-0.toml --knot square --tremor-mm 0.3 --frame-loss 0.02)";

/// Checks that every key is within reach. @throws Refusal before anything runs.
void check_reach(const Arguments& a, const scene::Scene& scene, const scene::GripperScript& script) {
  for (std::size_t h = 0; h < 2; ++h) {
    const auto hand = sim::script_hand(script, h, sim::WorkspaceMap(scene.hands));
    if (const auto* why = std::get_if<std::string>(&hand)) throw Refusal(a.script + ": " + *why);
  }
}

int execute(const Arguments& a) {
  const auto seeds = read_seeds(a.seeds);
  const auto knot = sim::knot_named(a.knot);
  if (!knot) throw Refusal("--knot: found \"" + a.knot + "\", allowed " + sim::knot_names());
  const auto wanted = std::string(knot->type) + " " + std::string(knot->handedness);
  const auto text = read_scene_text_or_refuse(a.scene);
  const auto scene = parse_scene_or_refuse(text, a.scene, a.overrides);
  check_tick(scene, a.scene);
  (void)make_or_refuse(scene, a.scene);
  const auto script = load_script_or_refuse(a.script);
  check_reach(a, scene, script);
  if (!a.out.empty()) {
    check_free(a.out, a.knot, seeds, a.force);
    make_folder(a.out);
  }
  const auto toml = scene::recorded_text(text, a.overrides, scene) + "\n# play " + a.script;
  validate::stop_asked = console::stop_requested;
  int tied = 0, played = 0;
  std::printf("%6s  %-24s %8s %13s %14s %6s\n", "seed", "found", "seconds", "periods lost", "stood still, s", "fault");
  for (std::uint32_t seed = seeds.first; seed <= seeds.last && !console::stop_requested(); ++seed) {
    const auto log = a.out.empty() ? std::filesystem::path() : recording_of(a.out, a.knot, seed);
    Played p;
    try {
      p = play_once(scene, a.scene, toml, script, a.trouble, seed, log);
    } catch (const validate::Interrupted&) {
      break;
    }
    ++played;
    tied += p.found == wanted;
    std::printf("%6u  %-24s %8.1f %13lld %14.3f %6d\n", seed, p.found.c_str(), p.seconds,
                static_cast<long long>(p.periods_lost), p.stood_still_s, p.fault);
    std::fflush(stdout);
  }
  std::printf("%s: %d of %d are a %s knot, %s\n", a.script.c_str(), tied, played, a.knot.c_str(), wanted.c_str());
  if (console::stop_requested()) return kInterrupted;
  return tied >= a.least * played ? kDone : kRunFailed;
}

void add_trouble(CLI::App& play, Trouble& t) {
  const auto number = [&play](const char* name, double& value, const char* what, double most) {
    play.add_option(name, value, what)->check(within(0.0, most))->capture_default_str();
  };
  number("--tremor-mm", t.tremor_mm, "Amplitude by which each hand trembles, at the device", 10.0);
  number("--late-ms", t.late_ms, "One hand begins up to so much after the other", 1000.0);
  number("--lost-share", t.lost_share, "Share of the periods that the controller loses, in stalls of 1 to 10", 0.5);
  number("--frame-loss", t.frame_loss, "Share of the process data frames that is lost", 0.5);
  number("--work-share", t.work_share, "Share of the thread's work budget that is there", 1.0);
}

}  // namespace

void add_play_command(CLI::App& app, int& exit_code) {
  auto* play =
      app.add_subcommand("play", "A script played through the whole chain by many hands, and its knots counted");
  auto a = std::make_shared<Arguments>();
  play->add_option("script", a->script, "Operator's script (CSV)")->required();
  play->add_option("--scene", a->scene, "Scene file (TOML)")->required();
  play->add_option("--knot", a->knot, "What it is to tie: " + sim::knot_names())->required();
  play->add_option("--set", a->overrides, "key=value over the scene's own; repeatable")
      ->type_name("KEY=VALUE")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  play->add_option("--seeds", a->seeds, "N or FIRST-LAST: another day each")->capture_default_str();
  play->add_option("--out", a->out, "Folder for the recordings; without it there are none")
      ->type_name("DIR")
      ->check(not_empty);
  play->add_flag("--force", a->force, "Replace the recordings of an earlier call");
  play->add_option("--least", a->least, "Share that must be that knot")->check(within(0.0, 1.0))->capture_default_str();
  add_trouble(*play, a->trouble);
  play->footer(kFooter);
  play->callback([a, &exit_code] { exit_code = execute(*a); });
}

}  // namespace ligature::lab
