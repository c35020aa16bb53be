// How far parameters may be pushed: finite, or stopped in time and named; never a non-finite number, never a hang.

#include <cmath>
#include <functional>
#include <limits>

#include "host/lab/experiments/experiment.hpp"
#include "host/lab/likely_cause.hpp"
#include "host/lab/outcome.hpp"
#include "host/lab/progress.hpp"
#include "host/lab/rehearsal.hpp"
#include "host/lab/report.hpp"

namespace ligature::lab {
namespace {

constexpr int kTicks = 2000;
constexpr double kSteps_s[] = {1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 1e-1};

/// How a trial ended.
struct Ending {
  std::string word;  ///< "finite", "stopped", "refused", or "LEAKED": a non-finite number got out
  double tick = 0.0;
  double node = 0.0;
  std::string cause;
};

bool all_finite(const physics::Simulation& sim) {
  for (const auto& p : sim.nodes_W()) {
    if (!p.allFinite()) return false;
  }
  const auto& d = sim.diagnostics();
  return sim.hand(physics::Hand::kLeft).f_W.allFinite() && sim.hand(physics::Hand::kRight).f_W.allFinite() &&
         std::isfinite(d.kinetic_J) && std::isfinite(d.potential_J) && std::isfinite(d.max_stretch) &&
         !std::isnan(d.min_gap_m);
}

/// The right hand takes the tip and draws it aside; the left takes the middle. Scaled to the ticks of the trial.
scene::GripperScript tug(double whole_s, double reach_m) {
  scene::GripperScript s;
  s.keys[0] = {{0.0, {0, 0, 3.0}, true}, {0.5 * whole_s, {0.3, 0, 3.2}, true}};
  s.keys[1] = {{0.0, {0, 0, 0.5}, true}, {0.5 * whole_s, {reach_m, 0, 1.0}, true}};
  return s;
}

Ending trial(const scene::Scene& scene, const scene::GripperScript& script, int ticks = kTicks) {
  try {
    Rehearsal r(scene, script);
    for (int k = 0; k < ticks; ++k) {
      const bool good = r.tick();
      if (!all_finite(r.simulation())) return {"LEAKED", double(k), -1.0, ""};
      const auto& d = r.simulation().diagnostics();
      if (!good) return {"stopped", double(d.bad_tick), double(d.bad_node), likely_cause(scene)};
    }
    return {"finite", double(ticks), -1.0, ""};
  } catch (const Refusal& refusal) {
    return {"refused", 0.0, -1.0, refusal.what()};
  }
}

/// A parameter and how a factor acts on it.
struct Dial {
  const char* name;
  int low, high;  ///< decades
  std::function<void(scene::Scene&, double)> turn;
};

std::vector<Dial> dials() {
  return {
      {"stretch_N", -6, 6, [](scene::Scene& s, double f) { s.suture.paper.stretch_N *= f; }},
      {"bend", -6, 6, [](scene::Scene& s, double f) { s.suture.paper.bend *= f; }},
      {"all damping", -6, 6,
       [](scene::Scene& s, double f) {
         s.suture.paper.stretch_damping *= f;
         s.suture.paper.bend_damping *= f;
         s.suture.paper.swivel_damping *= f;
         s.hands.coupling_N_s_per_m *= f;
       }},
      {"coupling_N_per_m", -6, 6, [](scene::Scene& s, double f) { s.hands.coupling_N_per_m *= f; }},
      {"node mass, 0.05 kg", -5, 4, [](scene::Scene& s, double f) { s.suture.paper.node_mass_kg *= f; }},
  };
}

/// The odd ones: name and scene.
std::vector<std::pair<std::string, Ending>> odd_cases(const scene::Scene& base) {
  std::vector<std::pair<std::string, Ending>> all;
  const auto with = [&](const char* name, int ticks, const std::function<void(scene::Scene&)>& change) {
    auto s = base;
    change(s);
    all.emplace_back(name, trial(s, tug(ticks * s.time.tick_s, 1.0), ticks));
  };
  const auto place = [](scene::Scene& s, const std::function<scene::Vec(int)>& at) {
    s.suture.initial = "odd";
    s.suture.initial_polyline_m.clear();
    for (int k = 0; k < s.suture.nodes; ++k) s.suture.initial_polyline_m.push_back(at(k));
  };
  with("all nodes in one point", kTicks, [&](scene::Scene& s) { place(s, [](int) { return scene::Vec{0, 0, 5.5}; }); });
  with("two nodes in one point", kTicks, [&](scene::Scene& s) {
    place(s, [](int k) { return scene::Vec{0, 0, 5.5 - 0.1 * (k == 20 ? 19 : k)}; });
  });
  with("folded back on itself", kTicks, [&](scene::Scene& s) {
    place(s, [](int k) { return scene::Vec{0, 0, 5.5 - 0.1 * (k < 25 ? k : 50 - k)}; });
  });
  with("folded at every node", kTicks, [&](scene::Scene& s) {
    place(s, [](int k) { return scene::Vec{0, 0, 5.5 - 0.1 * (k % 2)}; });
  });
  with("gravity 1e4", kTicks, [](scene::Scene& s) { s.world.gravity_m_per_s2 = {0, 0, -1e4}; });
  with("2 nodes", kTicks, [](scene::Scene& s) { s.suture.nodes = 2; });
  with("3 nodes", kTicks, [](scene::Scene& s) { s.suture.nodes = 3; });
  with("2000 nodes", 300, [](scene::Scene& s) { s.suture.nodes = 2000; });
  with("friction 1000", kTicks, [](scene::Scene& s) { s.contact.friction = 1000; });
  with("radius of a metre", kTicks, [](scene::Scene& s) { s.suture.radius_m = 1.0; });
  with("no stiffness at all", kTicks, [](scene::Scene& s) { s.suture.paper.stretch_N = s.suture.paper.bend = 0.0; });
  scene::GripperScript jump;
  jump.keys[1] = {{0.0, {0, 0, 0.5}, true}, {0.5, {0, 0, 0.5}, true}, {0.5 + 1e-9, {1.0, 0, 0.5}, true}};
  all.emplace_back("hand jumps 1 m", trial(base, jump));
  return all;
}

}  // namespace

int experiment_extremes(const Bench& bench) {
  const auto base = load_scene_or_refuse((bench.scenes / "paper.toml").string(), {});
  std::printf("extremes: %d ticks of a two-handed tug for each combination\n", kTicks);
  Table map({"parameter", "factor", "step_s", "ending", "tick", "node", "likely_cause"});
  Table odd({"case", "ending", "tick", "node", "likely_cause"});
  int trials = 0, leaked = 0, refused = 0, unnamed = 0, finite = 0;
  const auto count = [&](const Ending& e) {
    ++trials;
    leaked += e.word == "LEAKED";
    refused += e.word == "refused";
    finite += e.word == "finite";
    unnamed += e.word == "stopped" && (e.tick < 0 || e.node < 0);
  };
  bool table_one = false;
  {
    Progress progress;
    const auto all = dials();
    for (std::size_t k = 0; k < all.size(); ++k) {
      for (int decade = all[k].low; decade <= all[k].high; ++decade) {
        progress.show(static_cast<double>(k) / static_cast<double>(all.size()),
                      std::string(all[k].name) + " x 1e" + std::to_string(decade));
        for (const double step_s : kSteps_s) {
          auto s = base;
          all[k].turn(s, std::pow(10.0, decade));
          s.time = {step_s, 1};
          const auto e = trial(s, tug(kTicks * step_s, 1.0));
          count(e);
          if (decade == 0 && step_s == 1e-3) table_one = e.word == "finite";
          map.row({std::string(all[k].name), std::pow(10.0, decade), step_s, e.word, e.tick, e.node, e.cause});
        }
      }
    }
    for (const auto& [name, e] : odd_cases(base)) {
      count(e);
      odd.row({name, e.word, e.tick, e.node, e.cause});
    }
  }
  odd.print();
  map.write(bench.out / "extremes.csv");
  odd.write(bench.out / "extremes-odd.csv");
  draw("extremes.py", {bench.out / "extremes.csv"}, bench.out / "extremes.png");
  Verdict v("extremes");
  std::printf("%d trials: %d finite, %d stopped, %d refused\n", trials, finite, trials - finite - refused - leaked,
              refused);
  v.claim(leaked == 0, "trials in which a non-finite number got out", std::to_string(leaked), "0");
  v.claim(unnamed == 0, "stops that did not name tick and node", std::to_string(unnamed), "0");
  v.claim(table_one, "Table I at 1 ms", table_one ? "finite" : "not finite", "finite");
  return v.conclude(bench.out);
}

}  // namespace ligature::lab
