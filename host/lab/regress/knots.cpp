// Shipped loose knots, drawn tight by two hands and held. Rounding decides how a single pull goes, so each figure is
// the mean of eight pulls at different speeds.

#include <algorithm>
#include <iterator>

#include "host/lab/regress/scene.hpp"
#include "host/lab/rehearsal.hpp"
#include "host/lab/validate/overhand.hpp"

namespace ligature::regress {
namespace {

constexpr double kTo_N = 1.0, kSpeeds_m_per_s[] = {0.15, 0.16, 0.17, 0.18, 0.2, 0.21, 0.22, 0.24};
constexpr int kRest = 100, kMostPull = 1000, kHold = 300;  // ticks

std::string type_of(const physics::Simulation& sim) {
  const auto knot = lab::knot_of(sim);
  return knot.type + " " + knot.handedness;
}

/// Sums over the pulls, each divided by the number of pulls.
struct Means {
  double apart_mm = 0.0, tension_N = 0.0, overlap_d = 0.0, lost_percent = 0.0, kept = 0.0;
};

void add_pull(const scene::Scene& scene, double speed, Means& mean) {
  auto sim = validate::build(scene);
  validate::EndPull pull(sim);
  const std::string before = type_of(sim);
  const double share = 1.0 / static_cast<double>(std::size(kSpeeds_m_per_s)), d = 2.0 * scene.suture.radius_m;
  double lost = 0.0, nearest_m = 0.0;
  int ticks = 0;
  const auto tick = [&](double at) {
    pull.tick(at, scene.time.tick_s);
    lost += sim.diagnostics().time_lost, ++ticks;
    nearest_m = std::min(nearest_m, sim.diagnostics().min_gap_m);
  };
  for (int k = 0; k < kRest; ++k) tick(0.0);
  for (int k = 0; k < kMostPull && pull.tension_N() < kTo_N; ++k) tick(speed);
  for (int k = 0; k < kHold; ++k) tick(0.0);
  mean.apart_mm += share * 1000.0 * pull.distance_m();
  mean.tension_N += share * pull.tension_N();
  mean.overlap_d += share * -nearest_m / d;
  mean.lost_percent += share * 100.0 * lost / ticks;
  mean.kept += share * (type_of(sim) == before ? 1.0 : 0.0);
}

/// About three times the change of each figure when gravity changes by one part in 10^9.
struct Tolerances {
  double apart_mm, tension_N, overlap_d;
};
constexpr Tolerances kOneKnot{0.4, 0.03, 0.01}, kTwoThrows{3.0, 0.1, 0.05};

Figures pulled(const Bench& bench, const char* file, const Tolerances& tolerance) {
  const auto scene = lab::load_scene_or_refuse((bench.scenes / file).string(), {});
  Means mean;
  for (const double speed : kSpeeds_m_per_s) add_pull(scene, speed, mean);
  return {{"distance of the hands (mm)", mean.apart_mm, tolerance.apart_mm},
          {"tension in the hold (N)", mean.tension_N, tolerance.tension_N},
          {"largest overlap (d)", mean.overlap_d, tolerance.overlap_d},
          {"time lost (%)", mean.lost_percent, 2.0},
          {"share of knots kept", mean.kept, 0.0}};
}

}  // namespace

Figures overhand(const Bench& bench) { return pulled(bench, "suture-3-0-knot.toml", kOneKnot); }
Figures figure_eight(const Bench& bench) { return pulled(bench, "suture-3-0-figure-eight.toml", kOneKnot); }
Figures square(const Bench& bench) { return pulled(bench, "suture-3-0-square.toml", kTwoThrows); }
Figures granny(const Bench& bench) { return pulled(bench, "suture-3-0-granny.toml", kTwoThrows); }
Figures surgeons(const Bench& bench) { return pulled(bench, "suture-3-0-surgeons.toml", kTwoThrows); }

}  // namespace ligature::regress
