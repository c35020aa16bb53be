// Experiment `extremes`: how far parameters may be changed. A run must stay finite, or stop with the cause named; it
// must never return a non-finite number, and never hang.

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "host/console/progress.hpp"
#include "host/lab/experiments/experiment.hpp"
#include "host/lab/experiments/extremes.hpp"
#include "host/lab/likely_cause.hpp"
#include "host/lab/outcome.hpp"
#include "host/lab/rehearsal.hpp"
#include "host/lab/report.hpp"

namespace ligature::lab {
namespace {

namespace fs = std::filesystem;

constexpr int kTicks = 2000;
constexpr double kSteps_s[] = {1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 1e-1};

bool all_finite(const physics::Simulation& sim) {
  for (const auto& p : sim.nodes_W()) {
    if (!p.allFinite()) return false;
  }
  const auto& d = sim.diagnostics();
  return sim.hand(physics::Hand::kLeft).f_W.allFinite() && sim.hand(physics::Hand::kRight).f_W.allFinite() &&
         std::isfinite(d.kinetic_J) && std::isfinite(d.potential_J) && std::isfinite(d.max_stretch) &&
         !std::isnan(d.min_gap_m);
}

/// The right hand pulls the free end aside while the left hand holds the middle. The motion takes `whole_s`.
scene::GripperScript tug(double whole_s, double reach_m) {
  scene::GripperScript s;
  s.keys[0] = {{0.0, {0, 0, 3.0}, true}, {0.5 * whole_s, {0.3, 0, 3.2}, true}};
  s.keys[1] = {{0.0, {0, 0, 0.5}, true}, {0.5 * whole_s, {reach_m, 0, 1.0}, true}};
  return s;
}

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

/// Unusual scenes, by name, each run to its ending.
OddEndings odd_cases(const scene::Scene& base) {
  OddEndings all;
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
  all.emplace_back("hand jumps 1 m", trial(base, jump, kTicks));
  return all;
}

bool has_a_hand_nowhere(const scene::GripperScript& script, double t_s) {
  return std::any_of(std::begin(script.keys), std::end(script.keys), [&](const auto& keys) {
    const auto p = scene::sample(keys, t_s).p_W_m;
    return !std::all_of(p.begin(), p.end(), [](double x) { return std::isfinite(x); });
  });
}

}  // namespace

Ending trial(const scene::Scene& scene, const scene::GripperScript& script, int ticks) {
  try {
    Rehearsal r(scene, script);
    for (int k = 0; k < ticks; ++k) {
      const bool good = r.tick();
      if (!all_finite(r.simulation())) return {"LEAKED", double(k), -1.0, ""};
      const auto& d = r.simulation().diagnostics();
      if (!good && d.bad_node < 0 && has_a_hand_nowhere(script, r.time_s()))
        return {"stopped", double(d.bad_tick), -1.0, "a hand that is no number", true};
      if (!good) return {"stopped", double(d.bad_tick), double(d.bad_node), likely_cause(scene)};
    }
    return {"finite", double(ticks), -1.0, ""};
  } catch (const Refusal& refusal) {
    return {"refused", 0.0, -1.0, refusal.what()};
  }
}

void ExtremesMap::count(const Ending& e) {
  ++trials;
  leaked += e.word == "LEAKED";
  refused += e.word == "refused";
  finite += e.word == "finite";
  unnamed += e.word == "stopped" && (e.tick < 0 || (e.node < 0 && !e.by_hand));
}

void ExtremesMap::add(const char* parameter, double factor, double step_s, const Ending& e) {
  count(e);
  if (factor == 1.0 && step_s == 1e-3) as_shipped = e.word == "finite";
  map.row({std::string(parameter), factor, step_s, e.word, e.tick, e.node, e.cause});
}

void ExtremesMap::add(const std::string& odd_case, const Ending& e) {
  count(e);
  odd.row({odd_case, e.word, e.tick, e.node, e.cause});
}

namespace {

ExtremesMap paper_extremes(const fs::path& scenes) {
  const auto base = load_scene_or_refuse((scenes / "paper.toml").string(), {});
  ExtremesMap result;
  console::Progress progress("extremes");
  const auto all = dials();
  for (std::size_t k = 0; k < all.size(); ++k) {
    for (int decade = all[k].low; decade <= all[k].high; ++decade) {
      progress.show(static_cast<double>(k) / static_cast<double>(all.size()),
                    std::string(all[k].name) + " x 1e" + std::to_string(decade));
      for (const double step_s : kSteps_s) {
        auto s = base;
        all[k].turn(s, std::pow(10.0, decade));
        s.time = {step_s, 1};
        result.add(all[k].name, std::pow(10.0, decade), step_s, trial(s, tug(kTicks * step_s, 1.0), kTicks));
      }
    }
  }
  for (const auto& [name, e] : odd_cases(base)) result.add(name, e);
  return result;
}

void conclude(Verdict& v, const std::string& who, const ExtremesMap& m) {
  std::printf("%s: %d trials: %d finite, %d stopped, %d refused\n", who.c_str(), m.trials, m.finite,
              m.trials - m.finite - m.refused - m.leaked, m.refused);
  v.claim(m.leaked == 0, who + ": trials in which a non-finite number got out", std::to_string(m.leaked), "0");
  v.claim(m.unnamed == 0, who + ": stops that did not name tick and node (or hand)", std::to_string(m.unnamed), "0");
  v.claim(m.as_shipped, who + ": as shipped, at 1 ms", m.as_shipped ? "finite" : "not finite", "finite");
}

}  // namespace

int experiment_extremes(const Bench& bench) {
  Verdict v("extremes");
  std::printf("extremes: a two-handed tug for each combination; paper-4 with Table I, the rod with its suture\n");
  const std::pair<const char*, ExtremesMap> maps[] = {{"paper-4", paper_extremes(bench.scenes)},
                                                      {"rod", rod_extremes(bench.scenes)}};
  for (const auto& [who, m] : maps) {
    const std::string name = std::string("extremes") + (who == maps[0].first ? "" : "-rod");
    m.odd.print();
    m.map.write(bench.out / (name + ".csv"));
    m.odd.write(bench.out / (name + "-odd.csv"));
    draw("extremes.py", {bench.out / (name + ".csv")}, bench.out / (name + ".png"));
    conclude(v, who, m);
  }
  return v.conclude(bench.out);
}

}  // namespace ligature::lab
