// Experiment `models`: measures what each of the paper's five models adds (Table II of the paper): bending energy,
// damping of a zigzag and of a conical orbit, strain.

#include <array>
#include <cmath>

#include "host/lab/experiments/experiment.hpp"
#include "host/lab/rehearsal.hpp"
#include "host/lab/report.hpp"
#include "host/lab/run_files.hpp"
#include "protocol/scene/scene_file.hpp"

namespace ligature::lab {
namespace {

constexpr std::array kModels{scene::Model::kPaper1, scene::Model::kPaper2, scene::Model::kPaper3, scene::Model::kPaper4,
                             scene::Model::kPaper5};
constexpr double kStep_s = 0.0002;  // small enough to make the integrator's numerical dissipation negligible

using physics::Vec3;

struct Measured {
  double bend_J = 0.0;      ///< energy to fold the straight thread by 90 degrees at one node
  double ring_left = 0.0;   ///< fraction of the energy of a zigzag kick that is left after 1 s
  double orbit_left = 0.0;  ///< fraction of the energy of a conical orbit that is left after 20 s
  double stretch = 0.0;     ///< strain of the hanging thread at rest
};

scene::Scene with(scene::Scene s, scene::Model model) {
  s.suture.model = model;
  s.contact.solver = scene::ContactSolver::kNone;
  s.time = {kStep_s, 1};
  return s;
}

double energy(const Rehearsal& r) {
  return r.simulation().diagnostics().kinetic_J + r.simulation().diagnostics().potential_J;
}

/// Node positions of the hanging thread at rest, from a run with strong air drag.
std::vector<Vec3> rest_shape(scene::Scene s) {
  s.suture.paper.air_drag_per_s = 3.0;
  Rehearsal r(s, {});
  r.run_until(15.0);
  const auto nodes = r.simulation().nodes_W();
  return {nodes.begin(), nodes.end()};
}

/// Runs the thread for t_s, from positions p and velocities v. @return the share of its initial energy that is left.
/// Energies count from that of the thread at rest.
double energy_left(const scene::Scene& s, const std::vector<Vec3>& rest, const std::vector<Vec3>& p,
                   const std::vector<Vec3>& v, double t_s) {
  Rehearsal still(s, {}), kicked(s, {});
  still.simulation().set_state(rest, {});
  kicked.simulation().set_state(p, v);
  still.tick();
  kicked.tick();
  const double base_J = energy(still), start_J = energy(kicked) - base_J;
  kicked.run_until(t_s);
  return (energy(kicked) - base_J) / start_J;
}

double bend_energy(scene::Scene s) {
  s.world.gravity_m_per_s2 = {0.0, 0.0, 0.0};
  const int n = s.suture.nodes;
  const double l = s.suture.length_m / (n - 1);
  const auto energy_of = [&](bool folded) {
    std::vector<Vec3> p;
    for (int k = 0; k < n; ++k) {
      const double along = l * std::min(k, n / 2), aside = folded ? l * std::max(0, k - n / 2) : 0.0;
      p.emplace_back(aside, 0.0, 5.5 - along - (folded ? 0.0 : l * std::max(0, k - n / 2)));
    }
    auto tiny = s;
    tiny.time.tick_s = 1e-7;  // the energies after such a short tick are still those of the start shape
    Rehearsal r(tiny, {});
    r.simulation().set_state(p, {});
    r.tick();
    return r.simulation().diagnostics().potential_J;
  };
  return energy_of(true) - energy_of(false);
}

Measured measure(const scene::Scene& s) {
  const auto rest = rest_shape(s);
  const double l = s.suture.length_m / (s.suture.nodes - 1);
  // Zigzag: neighbouring nodes are kicked aside in opposite directions. Orbit: the thread is bent to one side, its free
  // end by 1.5 m, and kicked perpendicular to that plane, so that it circles instead of swinging.
  std::vector<Vec3> zigzag, bent, orbit;
  const double omega = std::sqrt(9.8 / s.suture.length_m) * 1.2;
  for (std::size_t k = 0; k < rest.size(); ++k) {
    const double u = static_cast<double>(k) / static_cast<double>(rest.size() - 1), aside_m = 1.5 * u * u;
    zigzag.emplace_back(k == 0 ? 0.0 : (k % 2 ? 1.0 : -1.0), 0.0, 0.0);
    bent.emplace_back(rest[k] + Vec3(aside_m, 0.0, 0.3 * aside_m));
    orbit.emplace_back(0.0, omega * aside_m, 0.0);
  }
  Measured m;
  m.bend_J = bend_energy(s);
  m.ring_left = energy_left(s, rest, rest, zigzag, 1.0);
  m.orbit_left = energy_left(s, rest, bent, orbit, 20.0);
  m.stretch = (rest.front().z() - rest.back().z()) / (l * (s.suture.nodes - 1)) - 1.0;
  return m;
}

/// Shapes every 0.1 s of a thread that is released from the horizontal, for the comparison of the models.
void record_shapes(const scene::Scene& s, CsvFile& file, double number) {
  auto level = s;
  lay_level(level);
  Rehearsal r(level, {});
  for (int k = 0; k <= 20; ++k) {
    r.run_until(0.1 * k);
    const auto nodes = r.simulation().nodes_W();
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      const double cells[] = {number, 0.1 * k, static_cast<double>(i), nodes[i].x(), nodes[i].y(), nodes[i].z()};
      file.row(cells);
    }
  }
}

}  // namespace

int experiment_models(const Bench& bench) {
  std::printf("models: what each adds (N = 50, step %.1f ms, the paper's swivel damper)\n", 1e3 * kStep_s);
  const auto base = load_scene_or_refuse((bench.scenes / "paper.toml").string(),
                                         {"suture.swivel=paper", "suture.air_drag_per_s=0.0"});
  Table table({"model", "fold_90deg_J", "ringing_left_after_1s", "orbit_left_after_20s", "static_stretch_percent"});
  std::array<Measured, 5> m;
  CsvFile shapes(bench.out / "models-shapes.csv", "model,t_s,node,x_m,y_m,z_m");
  for (std::size_t k = 0; k < kModels.size(); ++k) {
    const auto s = with(base, kModels[k]);
    m[k] = measure(s);
    record_shapes(s, shapes, static_cast<double>(k + 1));
    table.row(
        {std::string(scene::name(kModels[k])), m[k].bend_J, m[k].ring_left, m[k].orbit_left, 100.0 * m[k].stretch});
  }
  shapes.close();
  table.print();
  table.write(bench.out / "models.csv");
  draw("models.py", {bench.out / "models-shapes.csv"}, bench.out / "models.png");
  Verdict v("models");
  v.claim(std::abs(m[0].bend_J) < 1e-9 && m[1].bend_J > 0.1, "model 1 folds freely, model 2 resists, J",
          digits(m[0].bend_J) + " and " + digits(m[1].bend_J), "below 1e-9 and above 0.1");
  v.claim(m[1].ring_left > 0.8, "model 2 rings on: energy left 1 s after a kick", digits(m[1].ring_left), "above 0.8");
  v.claim(m[2].ring_left < 0.05, "model 3 damps the ringing: energy left", digits(m[2].ring_left), "below 0.05");
  v.claim(m[2].orbit_left > 0.6, "model 3 orbits on: energy left after 20 s", digits(m[2].orbit_left), "above 0.6");
  v.claim(m[3].orbit_left < 0.5 * m[2].orbit_left, "model 4 stops the orbit: energy left after 20 s",
          digits(m[3].orbit_left), "below half of model 3's");
  v.claim(m[4].stretch < m[3].stretch, "model 5 stretches less than model 4, percent",
          digits(100 * m[4].stretch) + " against " + digits(100 * m[3].stretch), "less");
  return v.conclude(bench.out);
}

}  // namespace ligature::lab
