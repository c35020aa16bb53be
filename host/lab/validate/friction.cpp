// Friction on a tilted desk: Coulomb's threshold, sticking without creep, and the stopping distance.

#include <cmath>
#include <numbers>
#include <vector>

#include "host/lab/validate/reference.hpp"
#include "host/lab/validate/specimen.hpp"

namespace ligature::validate {
namespace {

constexpr double kG = 9.81;

double radians(double degrees) { return degrees * std::numbers::pi / 180.0; }

/// A tenth of the suture's length, lying straight across the slope of a tilted desk; no drag.
scene::Scene lying(const Subject& subject, double mu, double degrees) {
  auto scene = real_thread(subject, 0.1, mu);
  // At accuracy `balanced`, 200 contacts on a desk exceed the work budget of a tick: up to a fifth of the simulated
  // time is lost (docs/measurements/accuracy.md), which falsifies stopping distance and creep. Therefore `fine`.
  if (subject.nodes >= 200 && !subject.accuracy) scene.suture.rod.accuracy = scene::Accuracy::kFine;
  set_drag(scene, 0.0);
  scene.world.desk_height_m = 0.0;
  scene.world.gravity_m_per_s2 = {0, kG * std::sin(radians(degrees)), -kG * std::cos(radians(degrees))};
  lay(scene, [&](double s) { return Vec3(s, 0, scene.suture.radius_m); });
  return scene;
}

double along(const physics::Simulation& sim) { return sim.nodes_W()[sim.nodes_W().size() / 2].y(); }

double way_after(physics::Simulation& sim, int ticks) {
  const double from = along(sim);
  for (int k = 0; k < ticks; ++k) proceed(sim, no_hands());
  return along(sim) - from;
}

/// Whether the thread moves, in 0.3 s, more than a tenth of the distance that it would slide a quarter of a degree
/// above the threshold.
bool slides(const Subject& subject, double mu, double degrees) {
  auto sim = build(lying(subject, mu, degrees));
  return std::abs(way_after(sim, 300)) > 0.1 * 0.5 * kG * radians(0.25) * 0.3 * 0.3;
}

}  // namespace

Findings incline_threshold(const Subject& subject) {  // reference: atan(mu)
  Findings all;
  for (const double mu : {0.1, 0.3, 0.5}) {
    const double truth = std::atan(mu) * 180.0 / std::numbers::pi;
    double low = truth - 1.5, high = truth + 1.5;
    for (int k = 0; k < 5; ++k) {
      const double middle = 0.5 * (low + high);
      (slides(subject, mu, middle) ? high : low) = middle;
    }
    all.push_back(absolute("mu = " + std::to_string(mu).substr(0, 3) + ": slides from, degrees", truth,
                           0.5 * (low + high), 0.5, "deg"));
  }
  return all;
}

// displacement on a desk half a degree below the angle at which the thread slides, from 0.1 s on; must be zero
Findings stick_creep(const Subject& subject) {
  Findings all;
  for (const double mu : {0.1, 0.3, 0.5}) {
    const auto scene = lying(subject, mu, std::atan(mu) * 180.0 / std::numbers::pi - 0.5);
    auto sim = build(scene);
    way_after(sim, 100);
    const double creep = std::abs(way_after(sim, 1000)) / (2.0 * scene.suture.radius_m);
    all.push_back(
        absolute("mu = " + std::to_string(mu).substr(0, 3) + ": creep, diameters/s", 0.0, creep, 1e-3, "diameters/s"));
  }
  return all;
}

Findings stopping_distance(const Subject& subject) {  // reference: v^2 / (2 mu g)
  Findings all;
  for (const auto& row : reference_rows("05_stopping_distance.csv")) {
    const double mu = number(row, "mu"), speed = number(row, "v0_m_s"), time = number(row, "time_s");
    const auto scene = lying(subject, mu, 0.0);
    auto sim = build(scene);
    const std::vector<Vec3> places(sim.nodes_W().begin(), sim.nodes_W().end());
    // The state's velocity is (displacement of the last step) / dt, so it belongs to the middle of that step. To give
    // the thread the speed v0 now, the state's velocity must be v0 + mu g dt / 2. (With v0 itself the thread would stop
    // v0 dt / 2 too early: 3 % of the distance for a stop in 2 ms.)
    const double earlier = speed + 0.5 * step_s(scene) * mu * kG;
    sim.set_state(places, std::vector<Vec3>(places.size(), Vec3(0, earlier, 0)));
    const double way = way_after(sim, static_cast<int>(1000.0 * time) + 50);
    all.push_back(relative("mu = " + row.at("mu") + ", " + row.at("v0_m_s") + " m/s: distance, m",
                           number(row, "distance_m(g=9.81)"), way, 0.02));
  }
  return all;
}

}  // namespace ligature::validate
