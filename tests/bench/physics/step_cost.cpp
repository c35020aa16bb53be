// Cost of a tick of the paper's models. Not run by ctest. Usage:
//   physics-step-cost table
//      us per step: median, p99, max for N = 20 .. 1000 and each broad phase
//   physics-step-cost one SCENARIO NODES TICKS [key=value ..]
//      one warmed-up run for callgrind; see instructions.py. SCENARIO is one of:
//      tied (the overhand script from 9 s on: a loose trefoil), tightened (from 10 s), coil (turns that touch)
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "tests/unit/physics/script_run.hpp"

namespace {

using namespace ligature;
using namespace ligature::physics;
using test::make;
using test::paper_scene;

/// The function whose instructions callgrind counts (instructions.py).
[[gnu::noinline]] void measured_tick(Simulation& sim, const std::array<ToolInput, 2>& tools) { sim.tick(tools); }

/// A thread of N nodes, with segments as long as its diameter, coiled so that neighbouring turns just touch. Without
/// gravity and bending stiffness it stays coiled.
Simulation coil(int nodes, const std::vector<std::string>& extra) {
  const double rest_m = 5.0 / (nodes - 1), radius_m = 0.5 * rest_m, turn_m = 4.0 * rest_m;
  std::vector<std::string> o{"suture.nodes=" + std::to_string(nodes),
                             "suture.radius_m=" + std::to_string(radius_m),
                             "world.gravity_m_per_s2=[0.0,0.0,0.0]",
                             "world.fixed=[]",
                             "suture.bend=0.0",
                             "time.tick_s=1e-5"};
  o.insert(o.end(), extra.begin(), extra.end());
  Simulation sim = make(paper_scene(o));
  std::vector<Vec3> p;
  for (int i = 0; i < nodes; ++i) {
    const double angle = i * rest_m / turn_m;
    p.emplace_back(turn_m * std::cos(angle), turn_m * std::sin(angle), 2.05 * radius_m * angle / 6.283185307179586);
  }
  std::vector<Vec3> v;  // compressing along the axis, so that turns touch
  for (const Vec3& x : p) v.emplace_back(0.0, 0.0, 4.0 * radius_m * (p.back().z() * 0.5 - x.z()) / p.back().z());
  sim.set_state(p, v);
  return sim;
}

struct Run {
  Simulation sim;
  scene::GripperScript script;
  double time_s = 0.0;
  bool scripted = true;
  std::array<ToolInput, 2> tools() {
    time_s += 1e-3;
    if (!scripted) return {};
    return {test::tool_at(script.keys[0], time_s), test::tool_at(script.keys[1], time_s)};
  }
};

Run prepare(const std::string& scenario, int nodes, std::vector<std::string> extra) {
  if (scenario == "coil") return {coil(nodes, extra), {}, 0.0, false};
  extra.insert(extra.begin(), "suture.nodes=" + std::to_string(nodes));
  Run run{make(paper_scene(extra)), test::overhand(), scenario == "tied" ? 9.0 : 10.0};
  test::play(run.sim, run.script, 0.0, run.time_s);
  return run;
}

int one(int argc, char** argv) {
  Run run = prepare(argv[2], std::atoi(argv[3]), {argv + 5, argv + argc});
  const int ticks = std::atoi(argv[4]);
  double contacts = 0.0;
  for (int k = 0; k < ticks; ++k) {
    measured_tick(run.sim, run.tools());
    contacts += run.sim.diagnostics().contacts;
  }
  std::printf("contacts %.2f knot %s finite %d\n", contacts / ticks, test::knot_of(run.sim).type.c_str(),
              run.sim.diagnostics().finite);
  return 0;
}

void row(const char* scenario, int nodes, const char* what, const std::vector<std::string>& extra) {
  Run run = prepare(scenario, nodes, extra);
  std::vector<double> us;
  double contacts = 0.0;
  for (int k = 0; k < 2000; ++k) {
    const auto tools = run.tools();
    const auto from = std::chrono::steady_clock::now();
    measured_tick(run.sim, tools);
    us.push_back(std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - from).count());
    contacts += run.sim.diagnostics().contacts / 2000.0;
  }
  std::sort(us.begin(), us.end());
  std::printf("%-10s %5d  %-8s %9.2f %9.2f %9.2f   %6.1f %s\n", scenario, nodes, what, us[1000], us[1980], us[1999],
              contacts, run.sim.diagnostics().finite ? "" : "stopped");
}

int table() {
  std::printf("%-10s %5s  %-8s %9s %9s %9s   %6s\n", "scenario", "N", "search", "median us", "p99", "max", "contacts");
  for (const int n : {20, 35, 50}) row("tightened", n, "auto", {});
  for (const int n : {20, 50, 100, 200, 500, 1000})
    for (const char* what : {"none", "brute", "bvh", "sweep", "auto"})
      row("coil", n, what,
          {std::strcmp(what, "none") == 0 ? "contact.solver=none" : std::string("contact.broad_phase=") + what});
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc == 2 && std::strcmp(argv[1], "table") == 0) return table();
  if (argc >= 5 && std::strcmp(argv[1], "one") == 0) return one(argc, argv);
  std::fputs("usage: physics-step-cost table | one tied|tightened|coil NODES TICKS [key=value ..]\n", stderr);
  return 2;
}
