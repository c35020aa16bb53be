#include "host/lab/run_command.hpp"

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <memory>
#include <optional>

#include "host/lab/option_checks.hpp"
#include "host/lab/outcome.hpp"
#include "host/lab/report.hpp"
#include "host/lab/run.hpp"
#include "host/lab/script_tools.hpp"
#include "sim_device/operator/knots.hpp"

namespace ligature::lab {
namespace {

struct Arguments {
  std::string scene;
  std::vector<std::string> overrides;
  std::string grippers;
  std::string tie;
  std::uint32_t seed = 1;
  std::optional<double> duration_s;
  std::string out = "out/lab";
  double shape_every_s = 0.02;
};

constexpr const char* kFooter = R"(
The scene's thread is stepped tick by tick, as fast as the machine can, by the physics that the real-time firmware runs.
DIR then holds these files; those of an earlier run stay until the new ones are whole:
  trace.csv     one row a tick: forces on the hands (world newtons, before hands.force_scale and the 3.3 N limit),
                energies, largest stretch, smallest gap between strands (the thread's length when none is near),
                contacts, and what the tick cost this thread in CPU time
  shape.csv     every node's position, at t = 0, every --shape-every and at the end
  summary.json  the knot with its history (looked at every 20 ms), extremes, forces, cost

Exit: 0 done; 2 scene, script or options refused, nothing written; 3 the run became non-finite (tick, node and likely
cause are named; the files hold everything before it); 130 interrupted, the files hold what was run.

Example: an overhand knot tied in the paper's suture, with 35 nodes instead of 50
  ligature-lab run scenes/paper.toml --grippers scenes/operators/overhand.csv --duration 30 \
      --set suture.nodes=35 --set contact.friction=0.3 --out out/overhand
and in a real one, by an operator that looks:
  ligature-lab run scenes/suture-3-0.toml --tie overhand --seed 3 --duration 25 --out out/tied)";

constexpr double kTyingTakes_s = 60.0;  // longer than any operator needs, with time left to watch the knot

void print(const RunSummary& s, const std::string& folder) {
  std::printf("%s, %d nodes, %lld ticks, %.3f s\n", s.model.c_str(), s.nodes, static_cast<long long>(s.ticks),
              s.duration_s);
  std::printf("knot        %s (%s)\n", s.knot.type.c_str(), s.knot.handedness.c_str());
  std::printf("history    ");
  for (const auto& [t_s, type] : s.knot_history) std::printf(" %.2f s: %s", t_s, type.c_str());
  std::printf("\nhand force  left max %.1f mean %.1f N, right max %.1f mean %.1f N (world)\n", s.left_N.max,
              s.left_N.mean(), s.right_N.max, s.right_N.mean());
  std::printf("stretch     at most %.2f %%; strands overlap at most %.3f diameters\n", 100.0 * s.max_stretch,
              s.max_penetration_diameters);
  std::printf("tick        median %.2f us, p99 %.2f us, max %.1f us; %.0f times real time\n", s.step_us.median,
              s.step_us.p99, s.step_us.max, s.realtime_factor);
  std::printf("files       %s/{trace.csv,shape.csv,summary.json}\n", folder.c_str());
}

int execute(const Arguments& a) {
  const auto scene = load_scene_or_refuse(a.scene, a.overrides);
  const auto script = a.grippers.empty() ? scene::GripperScript{} : load_script_or_refuse(a.grippers);
  const double duration_s = a.duration_s.value_or(a.tie.empty() ? default_duration_s(script) : kTyingTakes_s);
  if (!(duration_s >= scene.time.tick_s && duration_s <= 1e6)) {
    throw Refusal("--duration: found " + digits(duration_s) + ", allowed one tick (" + digits(scene.time.tick_s) +
                  " s) .. 1e6 s");
  }
  if (!(a.shape_every_s > 0.0 && std::isfinite(a.shape_every_s))) {
    throw Refusal("--shape-every: found " + digits(a.shape_every_s) + ", allowed more than 0 s");
  }
  Rehearsal rehearsal(scene, script, a.scene);
  if (!a.tie.empty()) {
    auto tier = sim::KnotTier::make(scene, a.tie, a.seed);
    if (const auto* why = std::get_if<std::string>(&tier)) throw Refusal("--tie: " + *why);
    rehearsal.let(std::get<sim::KnotTier>(std::move(tier)));
  }
  const auto summary = run(rehearsal, {a.out, duration_s, a.shape_every_s});
  print(summary, a.out);
  if (!summary.finite) throw Refusal(a.scene + ": " + summary.failure, kRunFailed);
  if (summary.interrupted) {
    std::fprintf(stderr, "ligature-lab: interrupted at t = %.3f s\n", summary.duration_s);
    return kInterrupted;
  }
  return kDone;
}

}  // namespace

void add_run_command(CLI::App& app, int& exit_code) {
  auto* run = app.add_subcommand("run", "Play a scene, with or without an operator's script, and write what happened");
  auto a = std::make_shared<Arguments>();
  run->add_option("scene", a->scene, "Scene file (TOML)")->required();
  run->add_option("--set", a->overrides, "key=value over the scene's own, any key, value as TOML writes it; repeatable")
      ->type_name("KEY=VALUE")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  run->add_option("--grippers", a->grippers, "Operator's script: CSV time,hand,x,y,z,grip")
      ->type_name("FILE")
      ->check(not_empty);
  run->add_option("--tie", a->tie,
                  "Instead of a script: an operator that looks at the thread ties " + sim::knot_names())
      ->type_name("KNOT")
      ->check(not_empty)
      ->excludes("--grippers");
  run->add_option("--seed", a->seed, "Which operator: pace, start, dwell, tremor")->capture_default_str();
  run->add_option("--duration", a->duration_s, "Simulated seconds [script's end + 9; 60 with --tie; else 10]")
      ->type_name("S");
  run->add_option("--out", a->out, "Folder for the three files")
      ->type_name("DIR")
      ->check(not_empty)
      ->capture_default_str();
  run->add_option("--shape-every", a->shape_every_s, "Seconds between shapes in shape.csv")
      ->type_name("S")
      ->capture_default_str();
  run->footer(kFooter);
  run->callback([a, &exit_code] { exit_code = execute(*a); });
}

}  // namespace ligature::lab
