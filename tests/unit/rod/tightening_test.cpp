// Force on a hand, and energy, while the knot of scenes/suture-3-0-knot.toml is pulled tight, held and released.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "tests/bench/rod/chatter.hpp"
#include "tests/unit/rod/tightening.hpp"

namespace ligature::test {
namespace {

// Change of the hands' force by remeshing: difference to a copy whose mesh stays fixed in that tick. Friction is off,
// because stick and slip amplify any small difference (3 % of 0.1 N, even between copies that do not remesh).
struct MeshSteps {
  int remeshes = 0;
  double beyond_N = -1.0;  ///< largest force step minus 0.5 % of the tension
};

MeshSteps steps_of_a_pull(double speed) {
  Tightening pull({"contact.friction=0"});
  auto& numerics = pull.sim().rod().numerics();
  numerics.settled_m_per_s = 1e-6;  // converged so far that the remaining difference is the mesh's
  numerics.settled_share = 0.0;
  numerics.max_passes = 200;
  numerics.work = 400'000'000;
  MeshSteps steps;
  for (int k = 0; k < 50 + 130 / speed && Tightening::force(pull.sim()) < 5.0; ++k) {
    pull.move(k < 50 ? 0.0 : speed);
    RodSimulation twin = pull.sim();
    twin.rod().hold_mesh(true);
    twin.tick(pull.tools());
    pull.sim().tick(pull.tools());
    const double f = Tightening::force(pull.sim());
    if (f < 0.05 || pull.sim().rod().report().remeshes == 0) continue;
    ++steps.remeshes;
    steps.beyond_N = std::max(steps.beyond_N, std::abs(f - Tightening::force(twin)) - 0.005 * f);
  }
  return steps;
}

// A remesh at a fast pull may change the force by 0.5 % of the tension plus 3 mN. The 3 mN are needed because strands
// slide by more than a segment per tick, with and without the remesh. The largest step differs from pull to pull by 0.6
// mN (standard deviation), so the mean of eight pulls is tested.
TEST(FineZone, MovesWithoutAForceStep) {
  constexpr int kPulls = 8;
  double beyond_N = 0.0;
  for (int k = 0; k < kPulls; ++k) {
    const MeshSteps steps = steps_of_a_pull(0.19 + 0.002 * k);
    EXPECT_GT(steps.remeshes, 10);
    beyond_N += steps.beyond_N / kPulls;
  }
  EXPECT_LT(beyond_N, 3e-3);
  RecordProperty("beyond_mN", std::to_string(1e3 * beyond_N));
}

// In this slow pull strands slide by only a tenth of a segment per tick, so force steps are due to remeshing alone.
// Their limit is 0.5 % of the tension. The largest measured step is 0.25 mN below this limit. It would be 0.17 mN above
// the limit if a split did not preserve the bending moments, and 0.55 mN above if a split did not preserve the smooth
// curve. The fast pull does not detect these errors.
TEST(FineZone, ItselfHardlyStepsTheForce) {
  const MeshSteps steps = steps_of_a_pull(0.02);
  EXPECT_GT(steps.remeshes, 10);
  EXPECT_LT(steps.beyond_N, 0.0);
  RecordProperty("beyond_mN", std::to_string(1e3 * steps.beyond_N));
}

// Virtual work: a contact's impulse must act on each node with the derivative of the gap by that node's position.
// Points of the smooth curves are weighted means of node positions x_k. So with the weights w_k and the normal n of a
// contact row, n . sum w_k x_k must equal the distance that the gap is measured from.
TEST(Sliding, ForcesActOnWhatTheGapIsMeasuredOn) {
  Tightening pull;
  for (int k = 0; k < 1000 && Tightening::force(pull.sim()) < 2.0; ++k) pull.tick(0.2);
  for (int k = 0; k < 200; ++k) pull.tick(0.0);
  const auto& state = pull.sim().rod().state();
  int curved = 0;
  double worst_m = 0.0, sum = 0.0;
  for (const auto& c : pull.sim().rod().contact_set().contacts()) {
    if (!c.is_pair() || dot(c.p, c.p) == 0.0) continue;
    physics::rod::Vec way{};
    for (int j = 0; j < c.count; ++j) {
      way += c.w[j] * state.x[static_cast<std::size_t>(c.node[j])];
      sum += c.w[j];
    }
    worst_m = std::max(worst_m, std::abs(dot(way, c.n) - c.gap_m - c.reach_m));
    curved += c.count > 4;
  }
  EXPECT_GT(curved, 5);
  EXPECT_LT(worst_m, 1e-3 * 3e-4);
  EXPECT_LT(std::abs(sum), 1e-12);
  RecordProperty("worst_d", std::to_string(worst_m / 3e-4));
}

// A slack loop that touches the tight knot is meshed as finely as the knot, not with segments of two to four diameters.
TEST(FineZone, CoversWhatLiesAgainstIt) {
  Tightening pull({}, "suture-3-0-square.toml");
  // Converging a tight knot needs more passes than the default budget allows.
  pull.sim().rod().numerics().work = 40'000'000;
  for (int k = 0; k < 100; ++k) pull.tick(0.0);
  for (int k = 0; k < 1000 && Tightening::force(pull.sim()) < 5.0; ++k) pull.tick(0.2);
  for (int k = 0; k < 500; ++k) pull.tick(0.0);
  const auto& mesh = pull.sim().rod().state().mesh;
  int loaded = 0;
  for (const auto& c : pull.sim().rod().contact_set().contacts()) {
    if (!c.is_pair() || dot(c.p, c.p) == 0.0) continue;
    ++loaded;
    for (const int k : {0, 2}) EXPECT_LT(mesh.rest[static_cast<std::size_t>(c.node[k])], 1.2 * 3e-4) << c.node[k];
  }
  EXPECT_GT(loaded, 10);
}

// A knot pulled to 5 N, held, and released by both hands: the largest rise of the total energy (kinetic, elastic and of
// the contacts' compliance) per tick within one second, and the energy at start and end.
struct Released {
  double rise_J = 0.0, start_J = 0.0, end_J = 0.0, give_J = 0.0, overlap_d = 0.0, lost = 0.0;
};

Released release(const char* scene, double speed, bool sudden) {
  Tightening pull({}, scene);
  for (int k = 0; k < 100; ++k) pull.tick(0.0);
  for (int k = 0; k < 1000 && Tightening::force(pull.sim()) < 5.0; ++k) pull.tick(speed);
  for (int k = 0; k < 500; ++k) pull.tick(0.0);
  for (int k = 0; k < 5000 && !sudden && Tightening::force(pull.sim()) > 0.1; ++k) pull.tick(-0.02);
  pull.tools()[0].grip = pull.tools()[1].grip = false;
  pull.move(0.0);
  Released r;
  double before = 0.0;
  for (int k = 0; k < 1000; ++k) {
    pull.sim().tick(pull.tools());
    const auto& d = pull.sim().diagnostics();
    const double now = d.kinetic_J + d.potential_J;
    if (k == 0) r.start_J = before = now;
    r.rise_J = std::max(r.rise_J, now - before);
    r.give_J = std::max(r.give_J, pull.sim().rod().energy().give_J);
    r.overlap_d = std::max(r.overlap_d, -d.min_gap_m / 3e-4);
    r.lost += d.time_lost / 1000;
    before = r.end_J = now;
  }
  return r;
}

// Contact, friction and remeshing are on. The tight knot keeps most of its bending energy.
TEST(Energy, NeverRisesWhileNobodyPulls) {
  for (const bool sudden : {true, false}) {
    const Released r = release("suture-3-0-knot.toml", 0.2, sudden);
    EXPECT_EQ(r.rise_J, 0.0) << (sudden ? "sudden" : "gentle");
    EXPECT_LT(r.end_J, 0.8 * r.start_J);
    EXPECT_GT(r.give_J, 1e-6);
  }
}

// Two throws jam and use up the budget. The energy would rise by up to 3 % in a tick if the contact tolerance grew with
// the free end's speed, or if a remesh restored bending energy that an earlier one had smoothed away. A rare rise of
// 1e-6 to 2e-6 J is tolerated: when Newton's method fails in a jam and sweeps take over, overlaps grow by 1e-4 d.
TEST(Energy, NeverRisesWhileNobodyPullsTwoThrows) {
  int rises = 0;
  for (const char* scene : {"suture-3-0-square.toml", "suture-3-0-surgeons.toml"}) {
    for (const bool sudden : {true, false}) {
      const Released r = release(scene, 0.2, sudden);
      const std::string name = std::string(scene) + (sudden ? " sudden" : " gentle");
      EXPECT_LT(r.rise_J, 4e-6) << name;
      rises += r.rise_J > 1e-8;
      EXPECT_LT(r.end_J, 0.95 * r.start_J) << name;
      EXPECT_GT(r.give_J, 1e-7) << name;
      EXPECT_LT(r.overlap_d, 0.06) << name;
      EXPECT_LT(r.lost, 0.15) << name;
    }
  }
  EXPECT_LE(rises, 1);
}

// Force on the hands while the strands slide over each other. When contact was computed between chords, whose normal
// jumps at every corner, this force had a chatter of 2 to 4 %.
TEST(Sliding, IsSmooth) {
  Tightening pull;
  std::vector<double> force;
  for (int k = 0; k < 1000 && Tightening::force(pull.sim()) < 1.0; ++k) {
    pull.tick(k < 50 ? 0.0 : 0.05);
    force.push_back(Tightening::force(pull.sim()));
  }
  const bench::Chatter chatter = bench::chatter(force, 0.05);
  EXPECT_GT(chatter.ticks, 100);
  EXPECT_LT(chatter.share(), 0.01);
}

}  // namespace
}  // namespace ligature::test
