// Experiment `stability`: the largest stable time step of each model, by bisection.

#include <array>
#include <cmath>
#include <vector>

#include "host/console/progress.hpp"
#include "host/lab/experiments/experiment.hpp"
#include "host/lab/outcome.hpp"
#include "host/lab/rehearsal.hpp"
#include "host/lab/report.hpp"
#include "protocol/scene/scene_file.hpp"

namespace ligature::lab {
namespace {

constexpr double kSwing_s = 20.0;  // duration of a trial: released from the horizontal, swinging freely
constexpr double kMaxGain = 0.02;  // energy gain, as a fraction of M g L, from which a run counts as unstable
constexpr int kNodes[] = {20, 35, 50, 100};
constexpr std::array kModels{scene::Model::kPaper1, scene::Model::kPaper2, scene::Model::kPaper3, scene::Model::kPaper4,
                             scene::Model::kPaper5};

/// Which of kModels and kNodes are measured, as indices.
struct Cases {
  std::vector<std::size_t> models, nodes;
};

/// Whether a swing of 20 s with this time step stays finite and gains less than 2 % of M g L in energy (M mass, L
/// length).
bool survives(scene::Scene scene, double dt_s) {
  scene.time = {dt_s, 1};
  Rehearsal r(scene, {});
  const auto& p = scene.suture.paper;
  const double scale_J = p.node_mass_kg * scene.suture.nodes * 9.8 * scene.suture.length_m;
  const auto energy = [&] { return r.simulation().diagnostics().kinetic_J + r.simulation().diagnostics().potential_J; };
  if (!r.tick()) return false;
  const double start_J = energy();
  while (r.time_s() < kSwing_s) {
    if (!r.tick() || !(energy() - start_J < kMaxGain * scale_J)) return false;
  }
  return true;
}

/// The largest stable time step, by bisection in its logarithm, to 2 %. Returns `low` if even `low` is unstable, and
/// `high` if `high` is stable.
double largest_step(const scene::Scene& scene, double low, double high) {
  if (survives(scene, high)) return high;
  if (!survives(scene, low)) return low;
  while (high / low > 1.02) {
    const double middle = std::sqrt(low * high);
    (survives(scene, middle) ? low : high) = middle;
  }
  return low;
}

/// Largest stable time steps, ms, measured with an independent prototype of the same equations; 0: the prototype found
/// no limit in the range that it searched.
struct Reference {
  scene::Integrator integrator;
  std::array<std::array<double, 4>, 5> largest_ms;  ///< [model][nodes]
};

/// Explicit Euler without bending damping becomes unstable slowly, so its largest stable step depends on how the energy
/// is monitored. How the prototype did that is unknown (its limits for model 1 were 0.11, 0.07 and 0.06 ms), so models
/// 1 and 2 have no reference for the forward scheme. With bending damping the limit is sharp: k_d l / k_l (k_d stretch
/// damping, k_l stretch stiffness, l segment length).
constexpr Reference kReferences[] = {
    {scene::Integrator::kSemiImplicit,
     {{{3.66, 2.86, 2.32, 1.67},
       {3.66, 2.86, 2.32, 1.67},
       {3.66, 2.74, 1.36, 0.32},
       {3.66, 2.74, 1.36, 0.32},
       {0, 0, 0, 0}}}},
    {scene::Integrator::kForward,
     {{{0, 0, 0, 0}, {0, 0, 0, 0}, {0.33, 0.18, 0.13, 0.06}, {0.33, 0.18, 0.13, 0.06}, {0, 0, 0, 0}}}},
};

scene::Scene scene_for(scene::Scene s, scene::Model model, int nodes) {
  s.suture.model = model;
  s.suture.nodes = nodes;
  s.contact.solver = scene::ContactSolver::kNone;
  lay_level(s);
  return s;
}

/// Measures the paper's explicit scheme for each model and compares it with the reference. @return the largest relative
/// deviation.
double add_explicit(const scene::Scene& base, const Cases& cases, const Reference& ref, Table& table,
                    console::Progress& progress) {
  const bool forward = ref.integrator == scene::Integrator::kForward;
  double worst = 0.0;
  for (const std::size_t m : cases.models) {
    std::vector<Cell> row{std::string(scene::name(kModels[m])),
                          std::string(forward ? "forward, explicit" : "semi-implicit, explicit")};
    for (const std::size_t n : cases.nodes) {
      progress.show(static_cast<double>(4 * m + n) / 20.0,
                    std::string(scene::name(kModels[m])) + ", N = " + std::to_string(kNodes[n]));
      auto s = scene_for(base, kModels[m], kNodes[n]);
      s.suture.paper.damping = scene::Damping::kExplicit;
      s.suture.paper.swivel = scene::SwivelDamper::kPaper;
      s.suture.paper.integrator = ref.integrator;
      s.suture.paper.quadratic_stretch = scene::QuadraticStretch::kPrinted;
      const double low_ms = forward ? 0.02 : 0.1;
      const double ms = 1e3 * largest_step(s, 1e-3 * low_ms, 20e-3);
      row.emplace_back(ms);
      if (const double r = ref.largest_ms[m][n]; r > 0.0) worst = std::max(worst, std::abs(ms / r - 1.0));
    }
    table.row(std::move(row));
  }
  return worst;
}

/// Measures the default scheme, with implicit damping. @return the largest stable step of paper-4 divided by 1 ms, the
/// smallest of the values at N = 20, 35 and 50 nodes.
double add_default(const scene::Scene& base, const Cases& cases, Table& table, console::Progress& progress) {
  double margin = 1e9;
  for (const std::size_t m : cases.models) {
    const auto model = kModels[m];
    std::vector<Cell> row{std::string(scene::name(model)), std::string("semi-implicit, implicit (default)")};
    for (const std::size_t n : cases.nodes) {
      const int nodes = kNodes[n];
      progress.show(0.5, std::string(scene::name(model)) + " default, N = " + std::to_string(nodes));
      const double s = largest_step(scene_for(base, model, nodes), 1e-4, 20e-3);
      row.emplace_back(1e3 * s);
      if (nodes <= 50 && model == scene::Model::kPaper4) margin = std::min(margin, s / 1e-3);
    }
    table.row(std::move(row));
  }
  return margin;
}

}  // namespace

int experiment_stability(const Bench& bench) {
  const Cases cases = bench.quick ? Cases{{3}, {0}} : Cases{{0, 1, 2, 3, 4}, {0, 1, 2, 3}};
  const auto base = load_scene_or_refuse((bench.scenes / "paper.toml").string(), {"suture.air_drag_per_s=0"});
  std::printf("stability: the largest step, ms, that survives a swing of %.0f s from level\n", kSwing_s);
  std::vector<std::string> columns{"model", "scheme"};
  for (const std::size_t n : cases.nodes) columns.push_back("N=" + std::to_string(kNodes[n]) + "_ms");
  Table table(columns);
  Verdict verdict("stability");
  double margin = 0.0, semi = 0.0, forward = 0.0;
  {
    console::Progress progress("stability");
    margin = add_default(base, cases, table, progress);
    semi = add_explicit(base, cases, kReferences[0], table, progress);
    forward = add_explicit(base, cases, kReferences[1], table, progress);
  }
  table.print();
  table.write(bench.out / "stability.csv");
  if (!bench.quick) draw("stability.py", {bench.out / "stability.csv"}, bench.out / "stability.png");
  verdict.claim(margin >= 2.0, "Table I with implicit dampers, model 4, N = 20, 35, 50, is stable beyond 1 ms by",
                digits(margin) + " times", "2 or more");
  verdict.claim(semi <= 0.15,
                "semi-implicit Euler with explicit dampers, models 1 to 4, differs from the prototype by at most",
                digits(100 * semi) + " %", "15 %");
  verdict.claim(forward <= 0.15, "forward Euler, models 3 and 4, differs from the prototype by at most",
                digits(100 * forward) + " %", "15 %");
  return verdict.conclude(bench.out);
}

}  // namespace ligature::lab
