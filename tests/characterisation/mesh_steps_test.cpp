// How much remeshing changes the hands' force, while the knot of scenes/suture-3-0-knot.toml is pulled tight.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

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

}  // namespace
}  // namespace ligature::test
