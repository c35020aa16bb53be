// Pulls a scene's loose knot tight and prints one line per pull; arguments and columns: rod_pull_study --help.

#include <CLI/CLI.hpp>
#include <cstdio>
#include <fstream>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "protocol/scene/scene_file.hpp"
#include "tests/bench/rod/pull.hpp"

using namespace ligature;
using namespace ligature::bench;
using physics::rod::RodSimulation;

namespace {

constexpr const char* kFooter = R"(
Pulls: two hands and one at 0.05, 0.2, 0.5 and 1 m/s to 1, 5 and 10 N, let go gently and suddenly (48); with SPEED and
FORCE the four of them; with SUDDEN (0, 1) and HANDS (1, 2) one, after which keys of the scene may stand. A line says:
the knot 5 s after the release and whether it is the one of the start; guard events; worst penetration, diameters, in
the pull, the hold and after; strain against T / EA; largest turn a node and longest segment in contact, in the hold;
chatter of the force in the hold and while sliding; share of the time in which the thread stood still for want of work,
in the pull, the hold (and 0.3 s before it), after, and in the hold alone; CPU time of the thread a tick, us, and work
on contact, thousand instructions: median, p99, worst.

--repeat N runs each pull N times. The rod is deterministic: every tick must do the same work and end with the same
nodes and forces, bit by bit, else the study fails. "least of N" is made of each tick's fastest run: what the tick
itself costs, without what interrupts, other processes and the hypervisor put on top in one run or the other.

Exit 0, or 1 when a knot was lost or a pull did not repeat itself, 2 for bad input.

Example
  rod_pull_study scenes/suture-3-0-knot.toml 0.2 5 0 2 suture.nodes=174 --repeat 5)";

struct Arguments {
  std::string scene;
  double speed = 0.0, force = 0.0;
  int sudden = 0, hands = 0, repeat = 1;
  std::vector<std::string> overrides, set;
  std::string ticks;
  PullOptions pull;
};

std::vector<Pull> pulls_of(const Arguments& a) {
  if (a.hands > 0) return {{a.speed, a.force, a.sudden != 0, a.hands}};
  std::vector<Pull> all;
  for (const int hands : {2, 1}) {
    if (a.speed > 0.0) {
      for (const bool sudden : {false, true}) all.push_back({a.speed, a.force, sudden, hands});
      continue;
    }
    for (const double speed : {0.05, 0.2, 0.5, 1.0}) {
      for (const double force_N : {1.0, 5.0, 10.0}) {
        for (const bool sudden : {false, true}) all.push_back({speed, force_N, sudden, hands});
      }
    }
  }
  return all;
}

void print(const char* name, const std::vector<double>& values) {
  std::printf(" %s %.0f %.0f %.0f", name, quantile(values, 0.5), quantile(values, 0.99), quantile(values, 1.0));
}

void print(const scene::Scene& scene, const Pull& pull, const PullResult& r, const Repeated& repeated) {
  std::printf(
      "%5.3f m/s %4.1f N %s %d hand(s): %s %s %s guard %d penetration %.2f %.3f %.2f strain %.2f%% (T/EA %.2f%%) "
      "turn %.2f segment %.2f d chatter %.4f%% sliding %.2f%% lost %.2f%% %.2f%% %.2f%%, hold alone %.2f%%",
      pull.speed_m_per_s, pull.force_N, pull.sudden ? "sudden" : "gentle", pull.hands, r.left.type.c_str(),
      r.left.handedness.c_str(), r.kept() ? "kept" : ("LOST, was " + r.begun.type).c_str(), r.guard, r.pull_d, r.hold_d,
      r.after_d, 100.0 * r.strain, 100.0 * r.tension_N / scene.suture.rod.EA_N, r.turn_rad, r.segment_d,
      100.0 * r.chatter, 100.0 * r.sliding, 100.0 * r.pull_lost, 100.0 * r.hold_lost, 100.0 * r.after_lost,
      100.0 * r.held_lost);
  std::vector<double> us, work_k;
  for (const auto& t : repeated.first()) us.push_back(t.us), work_k.push_back(1e-3 * static_cast<double>(t.work));
  print("us", us);
  print("work k", work_k);
  if (repeated.runs() > 1) print(("least of " + std::to_string(repeated.runs()) + " us").c_str(), repeated.least_us());
  std::printf("\n");
  std::fflush(stdout);
}

/// @return whether the knot was kept and all repetitions computed the same.
bool study(const scene::Scene& scene, const Pull& pull, const Arguments& a, std::ostream& ticks) {
  Repeated repeated;
  PullResult first;
  for (int k = 0; k < a.repeat; ++k) {
    auto made = RodSimulation::make(scene);
    if (auto* why = std::get_if<std::string>(&made)) std::fprintf(stderr, "%s\n", why->c_str()), std::exit(2);
    auto result = Puller(scene, std::get<RodSimulation>(std::move(made)), a.pull).run(pull);
    if (const auto tick = repeated.add(std::move(result.ticks))) {
      std::printf("%4.2f m/s %4.1f N %s %d hand(s): NOT REPEATED, run %d differs from tick %zu on\n",
                  pull.speed_m_per_s, pull.force_N, pull.sudden ? "sudden" : "gentle", pull.hands, k + 1, *tick);
      return false;
    }
    if (k == 0) first = std::move(result);
  }
  print(scene, pull, first, repeated);
  char name[64];
  std::snprintf(name, sizeof name, "%g,%g,%d,%d", pull.speed_m_per_s, pull.force_N, pull.sudden ? 1 : 0, pull.hands);
  if (!a.ticks.empty()) repeated.write(ticks, name);
  return first.kept();
}

}  // namespace

int main(int argc, char** argv) {
  Arguments a;
  CLI::App app("Pulls a scene's loose knot tight, holds it, lets go and looks what is left", "rod_pull_study");
  app.footer(kFooter);
  app.set_version_flag("--version", "rod_pull_study " LIGATURE_VERSION);
  app.add_option("SCENE", a.scene)->required();
  auto* const speed = app.add_option("SPEED", a.speed, "of each hand that pulls, m/s")->check(CLI::PositiveNumber);
  auto* const force = app.add_option("FORCE", a.force, "to pull to, N")->needs(speed)->check(CLI::PositiveNumber);
  speed->needs(force);
  auto* const sudden = app.add_option("SUDDEN", a.sudden, "1: let go suddenly")->check(CLI::Range(0, 1));
  auto* const hands = app.add_option("HANDS", a.hands, "that pull")->needs(sudden)->check(CLI::Range(1, 2));
  sudden->needs(hands);
  app.add_option("overrides", a.overrides, "keys of the scene file")->type_name("KEY=VALUE");
  app.add_option("--set", a.set, "KEY=VALUE, the same anywhere on the line; once for each key")
      ->allow_extra_args(false);
  app.add_option("--repeat", a.repeat, "runs of each pull")->check(CLI::Range(1, 1000));
  app.add_option("--ticks", a.ticks, "CSV of every tick of every run: time, work, and what disturbed it");
  app.add_option("--hold", a.pull.hold_s, "s")->envname("HOLD_S");
  app.add_option("--wait", a.pull.wait_s, "after the release, s")->envname("WAIT_S");
  app.add_option("--work", a.pull.work_k, "contact budget but its part a node, thousand instructions")
      ->envname("WORK_K");
  app.add_option("--shapes", a.pull.shapes, "folder for start.csv, held.csv, end.csv")->envname("SHAPES");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  a.overrides.insert(a.overrides.end(), a.set.begin(), a.set.end());
  auto read = scene::load_scene(a.scene, a.overrides);
  if (auto* error = std::get_if<scene::Error>(&read)) return std::fprintf(stderr, "%s\n", error->text.c_str()), 2;
  std::ofstream ticks;
  if (!a.ticks.empty()) {
    a.pull.disturbances = true;
    ticks.open(a.ticks);
    if (!ticks) return std::fprintf(stderr, "%s: cannot be written\n", a.ticks.c_str()), 2;
    ticks << "speed_m_per_s,force_N,sudden,hands,run,tick,us,work,faults,switches,steals_10ms\n";
  }
  std::size_t kept = 0;
  const auto pulls = pulls_of(a);
  for (const auto& pull : pulls) kept += study(std::get<scene::Scene>(read), pull, a, ticks);
  std::printf("%zu of %zu kept\n", kept, pulls.size());
  return kept == pulls.size() ? 0 : 1;
}
