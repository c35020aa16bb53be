// CPU time of a tick for N = 20 .. 1000 nodes: thread hanging free, and thread coiled in contact with itself.

#include <cmath>
#include <numbers>

#include "host/console/progress.hpp"
#include "host/lab/experiments/experiment.hpp"
#include "host/lab/rehearsal.hpp"
#include "host/lab/report.hpp"
#include "host/lab/statistics.hpp"

namespace ligature::lab {
namespace {

constexpr int kNodes[] = {20, 50, 100, 200, 500, 1000};
constexpr int kWarmUp = 300, kTimed = 3000;

/// Lays the thread as a helix whose turns touch: many contact pairs at every N.
void lay_coiled(scene::Scene& s) {
  const double l = s.suture.length_m / (s.suture.nodes - 1), pitch_m = 2.02 * s.suture.radius_m;
  constexpr double kRadius_m = 0.35;
  s.suture.initial = "coiled";
  s.suture.initial_polyline_m.clear();
  const double rise = pitch_m / (2 * std::numbers::pi), per_rad = std::hypot(kRadius_m, rise);
  for (int k = 0; k < s.suture.nodes; ++k) {
    const double a = k * l / per_rad;
    s.suture.initial_polyline_m.push_back({kRadius_m * std::cos(a), kRadius_m * std::sin(a), 5.5 - rise * a});
  }
}

struct Cost {
  Spread us;
  double contacts = 0.0;
  bool finite = true;
};

Cost measure(const scene::Scene& scene) {
  Rehearsal r(scene, {});
  Cost cost;
  std::vector<double> us;
  MaxMean contacts;
  for (int k = 0; k < kWarmUp + kTimed && cost.finite; ++k) {
    cost.finite = r.tick();
    if (k < kWarmUp) continue;
    us.push_back(r.last_tick_us());
    contacts.add(r.simulation().diagnostics().contacts);
  }
  cost.us = spread_of(std::move(us));
  cost.contacts = contacts.mean();
  return cost;
}

}  // namespace

int experiment_cost(const Bench& bench) {
  auto scene = load_scene_or_refuse((bench.scenes / "paper.toml").string(), {"suture.reference_nodes=50"});
  scene.world.fixed.clear();
  std::printf("bench: CPU time of a tick, us (%d ticks after %d to warm up; the same thread at every N)\n", kTimed,
              kWarmUp);
  Table table({"nodes", "case", "step_s", "contacts", "median_us", "p99_us", "max_us"});
  Verdict v("bench");
  double free_100 = 0.0, free_1000 = 0.0;
  bool finite = true;
  {
    console::Progress progress("cost");
    for (const int n : kNodes) {
      scene.suture.nodes = n;
      scene.time.tick_s = n <= 50 ? 1e-3 : 1e-3 * std::pow(50.0 / n, 2);
      for (const bool coiled : {false, true}) {
        progress.show(n / 1000.0, "N = " + std::to_string(n));
        if (coiled)
          lay_coiled(scene);
        else
          lay_level(scene);
        const auto c = measure(scene);
        table.row({double(n), std::string(coiled ? "coiled" : "free"), scene.time.tick_s, c.contacts, c.us.median,
                   c.us.p99, c.us.max});
        finite = finite && c.finite;
        if (!coiled && n == 100) free_100 = c.us.median;
        if (!coiled && n == 1000) free_1000 = c.us.median;
      }
    }
  }
  table.print();
  table.write(bench.out / "bench.csv");
  draw("bench.py", {bench.out / "bench.csv"}, bench.out / "bench.png");
  const double growth = free_1000 / free_100, allowed = 10.0 * std::log(1000.0) / std::log(100.0);
  v.claim(finite, "every case stays finite", finite ? "yes" : "no", "yes");
  v.claim(growth <= allowed, "cost at N = 1000 over cost at N = 100, free", digits(growth),
          "up to " + digits(allowed) + " (N log N)");
  return v.conclude(bench.out);
}

}  // namespace ligature::lab
