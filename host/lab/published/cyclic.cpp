// A surgeon's knot of three throws (2-1-1) in 4-0 polypropylene under cycles of load, as in a test of knot security.

#include <algorithm>
#include <cmath>
#include <limits>

#include "host/lab/published/case.hpp"
#include "host/lab/published/knot_extent.hpp"
#include "host/lab/published/throws.hpp"
#include "host/lab/published/two_hands.hpp"

namespace ligature::published {
namespace {

using physics::rod::RodSimulation;
using validate::Vec3;

constexpr double kDiameter_m = 1.75e-4, kTying_N = 3.0, kLow_N = 2.0, kSpeed_m_per_s = 0.05;
constexpr double kHeld_d = 30.0;  // the hands hold the strands of the loop this far from the knot
const std::array<Vec3, 2> kApart{-Vec3::UnitX(), Vec3::UnitX()};

/// Polypropylene 4-0 (the preset of scene files), with the friction that the shipped scenes have. The throws lie close
/// together, as after a surgeon has drawn each one tight before the next.
scene::Scene polypropylene(const Subject& subject, bool sets) {
  auto scene = validate::real_thread(subject.rod(200), 1.0, 0.3);
  auto& rod = scene.suture.rod;
  scene.suture.radius_m = 0.5 * kDiameter_m;
  rod.density_kg_per_m = 2.19e-5, rod.EA_N = 72.2, rod.EI_N_m2 = 1.38e-7, rod.GJ_N_m2 = 9.87e-8;
  rod.spacing = scene::Spacing::kAdaptive;
  if (sets) rod.yield_strain = 0.1, rod.set_fraction = 0.35;  // docs/rod-set.md
  lay_curve(scene, curve_of({.half_turns = {5, -3, 3},
                             .aside_d = 0.8,
                             .half_turn_d = 4.0,
                             .between_d = 5.0,
                             .rounding_d = 0.5,
                             .loop_d = 400.0,
                             .tail_d = 170.0},
                            kDiameter_m));
  return scene;
}

/// Draws the tails, then the strands below the knot, to the tying force. Then the hands hold these strands slack.
void tie(const RodSimulation& sim, TwoHands& hands) {
  const auto draw = [&](double from, double to) {
    hands.take(place_at(sim, from), place_at(sim, to));
    hands.pull_to(kTying_N, kApart, kSpeed_m_per_s, 8000);
    hands.rest(200);
    hands.pull_to(0.0, kApart, kSpeed_m_per_s, 2000);
  };
  draw(0.0, sim.rod().state().mesh.s.back());
  const KnotExtent knot = extent_of(sim);
  draw(knot.loop_0 + kHeld_d * kDiameter_m, knot.loop_1 - kHeld_d * kDiameter_m);
}

/// The larger slip of the two tails, d. NaN when the knot has no contact because the work budget did not suffice to
/// solve any.
double slip_d(const KnotExtent& tied, const KnotExtent& now) {
  if (now.tail_1 == 0.0) return std::numeric_limits<double>::quiet_NaN();
  return std::max(tied.tail_0 - now.tail_0, now.tail_1 - tied.tail_1) / kDiameter_m;
}

/// Ties a thread and puts it under cycles of load. The knot is tied at accuracy `fine` in any case, so that every
/// setting loads the same knot.
void load_cycles(const Subject& subject, bool sets, Result& result) {
  const std::string thread = sets ? "bends that set, " : "elastic, ";
  const auto scene = polypropylene({scene::Accuracy::kFine}, sets);
  auto sim = std::get<RodSimulation>(RodSimulation::make(scene));
  TwoHands hands(sim, scene.time.tick_s);
  const std::string knot = knot_in(sim.nodes_W());
  tie(sim, hands);
  const KnotExtent tied = extent_of(sim);
  auto loaded = std::get<RodSimulation>(RodSimulation::make(polypropylene(subject, sets)));
  static_cast<void>(loaded.continue_from(sim));
  std::swap(sim, loaded);  // the hands act on `sim`
  int done = 0;
  for (const double load_N : subject.quick ? std::vector{10.0} : std::vector{10.0, 20.0}) {
    const int cycles = subject.quick ? 3 : 200;
    double lost = 0.0, slip = 0.0;
    bool reached = true;
    int k = 0;
    for (; k < cycles && reached; ++k, ++done) {  // until the knot has run open and carries no load
      // Each of the two strands of the loop carries half of the load.
      reached = hands.pull_to(0.5 * load_N, kApart, kSpeed_m_per_s, 4000);
      lost = std::max(lost, sim.rod().report().time_lost);
      reached &= hands.pull_to(0.5 * kLow_N, kApart, kSpeed_m_per_s, 4000);
      slip = slip_d(tied, extent_of(sim));
      result.points.push_back({thread + "2-" + std::to_string(int(load_N)) + " N", double(done + 1), 3.0, slip});
    }
    const std::string what = thread + std::to_string(k) + " of " + std::to_string(cycles) + " cycles of 2-" +
                             std::to_string(int(load_N)) + " N: ";
    const bool kept = reached && knot_in(sim.nodes_W()) == knot;
    result.findings.push_back(validate::absolute(what + "knot kept", 1.0, kept, 0.0, "(1: yes)"));
    result.findings.push_back(validate::within(what + "slip of a tail, d", -3.0, 3.0, slip));
  }
}

}  // namespace

Result cyclic(const Subject& subject) {
  Result result;
  if (!subject.quick) load_cycles(subject, false, result);
  load_cycles(subject, true, result);
  return result;
}

}  // namespace ligature::published
