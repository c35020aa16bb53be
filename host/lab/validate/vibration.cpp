// Natural frequencies, from zero crossings of the modal amplitude, and numerical damping of a mode by the time step.

#include <cmath>
#include <numbers>
#include <vector>

#include "host/lab/validate/reference.hpp"
#include "host/lab/validate/rods.hpp"
#include "host/lab/validate/specimen.hpp"
#include "host/lab/validate/vibration.hpp"

namespace ligature::validate {
namespace {

// time step, as a multiple of 1 / omega (omega: the mode's frequency): implicit Euler then errs by 3e-5 in frequency
// and damps by 0.5 % of critical damping
constexpr double kStep = 0.01;
constexpr double kSmall = 1e-4;

/// Angular frequency from the mean distance of zero crossings. `next` runs one tick and returns the amplitude; `before`
/// is the amplitude at the start.
template <class Next>
double frequency(double before, double tick_s, int crossings, Next next) {
  double first = 0.0, last = 0.0, t = 0.0;
  for (int seen = 0, ticks = 0; seen <= crossings && ticks < 100000; ++ticks) {
    const double now = next();
    t += tick_s;
    if ((before > 0.0) != (now > 0.0)) {
      const double at = t - tick_s * now / (now - before);
      if (seen == 0) first = at;
      last = at;
      ++seen;
    }
    before = now;
  }
  return std::numbers::pi * crossings / (last - first);
}

/// Shape of the mode with frequency `omega` of N equal masses at the ends of N links, from the top (0) to the free end
/// (1). Laguerre recurrence from the free end; the tension in a link is the weight below it.
std::vector<double> chain_shape(int masses, double omega) {
  std::vector<double> y(static_cast<std::size_t>(masses) + 1, 1.0);
  double slope = 0.0;
  for (int k = masses; k > 0; --k) {
    const double below = masses - k;  // weight below the link under node k, in units of m g
    slope = (below * slope + omega * omega * y[static_cast<std::size_t>(k)]) / (below + 1.0);
    y[static_cast<std::size_t>(k - 1)] = y[static_cast<std::size_t>(k)] - slope / masses;
  }
  return y;
}

double chain_frequency_of_rod(int masses, double omega, const std::vector<double>& y) {
  const double tick = kStep / omega;
  Material m = unit_rod();
  m.EI_N_m2 = 0.0;
  Rod rod(m, steps_of(tick), kBare, masses + 1);
  auto& state = rod.state();
  rod.gravity = make(0, 0, -1);
  rod.support(0, make(0, 0, 0));
  rod.moved();
  // equal masses, as in the reference: the last one is not halved
  for (auto& mass : state.mesh.mass) mass = 1.0 / masses;
  for (std::size_t i = 0; i < y.size(); ++i) state.x[i] = make(kSmall * (y[i] - y[0]), 0, -state.mesh.s[i]);
  const auto amplitude = [&] {
    double q = 0.0;
    for (std::size_t i = 0; i < y.size(); ++i) q += y[i] * state.x[i][0];
    return q;
  };
  return frequency(amplitude(), tick, 6, [&] { return proceed(rod), amplitude(); });
}

double chain_frequency_of_paper(const Subject& subject, double omega, const std::vector<double>& y) {
  const double tick = 0.05 / omega;
  auto scene = unit_thread({subject.model, static_cast<int>(y.size())}, tick, 0.0);
  set_bending(scene, 0.0);
  scene.world.gravity_m_per_s2 = {0, 0, -1};
  scene.world.fixed.push_back({0, {0, 0, 0}, std::nullopt});
  lay(scene, [&](double s) {
    const auto i = static_cast<std::size_t>(std::lround(s / segment_m(scene)));
    return Vec3(kSmall * (y[i] - y[0]), 0, -s);
  });
  auto sim = build(scene);
  const Tools tools = no_hands();
  const auto amplitude = [&] {
    double q = 0.0;
    for (std::size_t i = 0; i < y.size(); ++i) q += y[i] * sim.nodes_W()[i].x();
    return q;
  };
  return frequency(amplitude(), tick, 6, [&] { return proceed(sim, tools), amplitude(); });
}

/// A cantilever that vibrates in one of its modes, simulated by physics::Simulation.
struct Ringing {
  Ringing(scene::Scene s, double beta, double length_m) : scene(std::move(s)), beta_(beta), length_m_(length_m) {
    clamp_start(scene);
    lay(scene, [&](double at) { return Vec3(at, kSmall * length_m_ * shape(at), 0); });
    sim = build(scene);
  }
  double shape(double s) const { return cantilever_shape(beta_, std::max(0.0, s - clamp_end_m(scene)) / length_m_); }
  /// Projection on the mode's shape, which filters out other modes.
  double amplitude() const {
    double q = 0.0;
    for (int i = 0; i < scene.suture.nodes; ++i) {
      const double s = i * segment_m(scene), share = is_rod(scene) && i + 1 == scene.suture.nodes ? 0.5 : 1.0;
      q += share * shape(s) * sim.value().nodes_W()[static_cast<std::size_t>(i)].y();
    }
    return q;
  }
  scene::Scene scene;
  std::optional<physics::Simulation> sim;

 private:
  double beta_, length_m_;
};

}  // namespace

double cantilever_shape(double beta, double s) {
  const double c = (std::cosh(beta) + std::cos(beta)) / (std::sinh(beta) + std::sin(beta));
  return std::cosh(beta * s) - std::cos(beta * s) - c * (std::sinh(beta * s) - std::sin(beta * s));
}

Findings hanging_chain(const Subject& subject) {  // reference: zeros of Laguerre polynomials, exact
  Findings all;
  for (const auto& row : reference_rows("03_hanging_chain_modes_discrete.csv")) {
    const int masses = static_cast<int>(number(row, "N_masses"));
    if (masses != subject.nodes) continue;
    const double omega = number(row, "omega_times_sqrt(L_over_g)");
    const auto y = chain_shape(masses, omega);
    const double found = subject.model == scene::Model::kRod ? chain_frequency_of_rod(masses, omega, y)
                                                             : chain_frequency_of_paper(subject, omega, y);
    all.push_back(
        relative(row.at("N_masses") + " masses, mode " + row.at("mode") + ": omega sqrt(L/g)", omega, found, 5e-3));
  }
  return all;
}

// reference: cosh beta cos beta = -1; lumped masses lower the frequencies by O(1 / N^2)
Findings cantilever_frequencies(const Subject& subject) {
  Findings all;
  for (const auto& row : reference_rows("03_bending_modes.csv")) {
    if (row.at("ends") != "cantilever" || number(row, "mode") > 3) continue;
    const double omega = number(row, "omega_times_L2_sqrt(rhoA_over_EI)");
    // In a paper model the last node has a full mass, as if the thread were half a segment longer. The clamp holds half
    // a segment at the start, so the free length is 1.
    Ringing r(unit_thread(subject, 0.1 / omega, 0.0), number(row, "beta_L"), 1.0);
    const double found =
        frequency(r.amplitude(), 0.1 / omega, 6, [&] { return proceed(*r.sim, no_hands()), r.amplitude(); });
    all.push_back(relative("f" + row.at("mode") + ": omega", omega, found, row.at("mode") == "1" ? 0.01 : 0.03));
  }
  return all;
}

double numerical_damping(const Subject& subject, scene::Accuracy accuracy, int mode) {
  auto scene = real_thread(subject, 1.0, 0.0);
  auto& r = scene.suture.rod;
  r.damping_s = r.stretch_damping_s = r.air_drag_per_s = 0.0;
  r.accuracy = accuracy;
  scene.contact.solver = scene::ContactSolver::kNone;
  const double betas[] = {1.87510406871, 4.69409113297, 7.85475743824}, beta = betas[mode - 1];
  const double length = scene.suture.length_m;
  const double omega = beta * beta * std::sqrt(r.EI_N_m2 / r.density_kg_per_m) / (length * length);
  Ringing ringing(scene, beta, length);
  const double from = std::abs(ringing.amplitude());
  // After whole periods the amplitude is at its peak again; there a small error of the period hardly changes it (second
  // order).
  const int periods = 4,
            ticks = static_cast<int>(std::lround(periods * 2.0 * std::numbers::pi / omega / scene.time.tick_s));
  double peak = 0.0;
  const int around = ticks / (4 * periods);
  for (int k = 0; k < ticks + around; ++k) {
    proceed(ringing.sim.value(), no_hands());
    if (k >= ticks - around) peak = std::max(peak, std::abs(ringing.amplitude()));
  }
  return std::log(from / peak) / (2.0 * std::numbers::pi * periods);
}

Findings cantilever_damping(const Subject& subject) {
  Findings all;
  const std::pair<scene::Accuracy, const char*> levels[] = {
      {scene::Accuracy::kFast, "fast"}, {scene::Accuracy::kBalanced, "balanced"}, {scene::Accuracy::kFine, "fine"}};
  for (const auto& [accuracy, name] : levels) {
    for (int mode = 1; mode <= 3; ++mode) {
      const double zeta = numerical_damping(subject, accuracy, mode);
      const bool judged = accuracy == scene::Accuracy::kFine && mode == 1;
      auto f = absolute(std::string(name) + ", mode " + std::to_string(mode) + ": share of critical damping", 0.0, zeta,
                        judged ? 1e-3 : 1.0, "of critical");
      all.push_back(f);
    }
  }
  return all;
}

}  // namespace ligature::validate
