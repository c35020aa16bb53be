#include "host/lab/published/lock_test.hpp"

#include <cmath>
#include <limits>

#include "host/lab/validate/overhand.hpp"

namespace ligature::published {
namespace {

constexpr double kTakenUp_N = 0.2, kTakeUpSpeed_m_per_s = 0.05;
constexpr int kHoldTicks = 500, kMostTicks = 60000;

/// Length of the thread, stretch included, less the distance of its ends: falls when thread is drawn out of the knot.
double excess_m(const physics::Simulation& sim) {
  const auto x = sim.nodes_W();
  double length = 0.0;
  for (std::size_t k = 1; k < x.size(); ++k) length += (x[k] - x[k - 1]).norm();
  return length - (x.back() - x.front()).norm();
}

/// The thread of scenes/suture-3-0.toml, without gravity.
scene::Scene scene_of(const Subject& subject, const Drawing& d) {
  auto scene = validate::real_thread(subject.rod(154), 1.0, d.friction);
  scene.suture.rod.GJ_N_m2 = 2.86e-7;
  scene.suture.rod.spacing = scene::Spacing::kAdaptive;
  lay_curve(scene, curve_of(d.throws, 2.0 * scene.suture.radius_m));
  return scene;
}

}  // namespace

Lock draw_to_lock(const Subject& subject, const Drawing& d) {
  const auto scene = scene_of(subject, d);
  auto sim = validate::build(scene);
  const double diameter = 2.0 * scene.suture.radius_m, dt = scene.time.tick_s;
  const std::string loose = knot_in(sim.nodes_W());
  validate::EndPull pull(sim);
  for (int k = 0; k < 100; ++k) pull.tick(0.0, dt);
  for (int k = 0; k < kMostTicks && pull.tension_N() < kTakenUp_N; ++k) pull.tick(kTakeUpSpeed_m_per_s, dt);
  Lock found;
  double excess = excess_m(sim);
  for (int k = 0; k < kMostTicks && !found.reached && excess > 0.5 * diameter * d.throws.loop_d; ++k) {
    pull.tick(d.speed_m_per_s, dt);
    excess = excess_m(sim);
    found.reached = pull.tension_N() >= d.to_N;
  }
  for (int k = 0; k < kHoldTicks; ++k) pull.tick(0.0, dt);
  found.slip_d = (excess - excess_m(sim)) / diameter;
  found.left_N = pull.tension_N();
  found.same_knot = knot_in(sim.nodes_W()) == loose;
  found.locked = found.reached && found.same_knot && found.slip_d < 5.0 && found.left_N > 0.9 * d.to_N;
  return found;
}

double locking_friction(const Subject& subject, Drawing d, double low, double high, double apart) {
  constexpr double kStep = 1.25;
  const auto locks = [&](double friction) {
    d.friction = friction;
    return draw_to_lock(subject, d).locked;
  };
  double slips = low / kStep, holds = low;
  while (!locks(holds)) {
    slips = holds, holds *= kStep;
    if (holds > high) return std::numeric_limits<double>::infinity();
  }
  while (holds > apart * slips) {
    const double middle = std::sqrt(slips * holds);
    (locks(middle) ? holds : slips) = middle;
  }
  return std::sqrt(slips * holds);
}

}  // namespace ligature::published
