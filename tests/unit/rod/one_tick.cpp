// usage: rod-one-tick SEED PASSES: one substep of a ball of thread that hits a floor, with PASSES passes of the solver
// over the contacts. Prints the estimated work, the passes made and the contacts. test_pass_price.py compares the
// estimate with the true number of instructions.

#include <cstdio>
#include <cstdlib>

#include "tests/unit/rod/crumple.hpp"

int main(int argc, char** argv) {
  using namespace ligature::test;
  if (argc != 3) return 2;
  Numerics numerics;
  numerics.tick_s = 6.25e-5;
  numerics.substeps = numerics.max_substeps = 1;
  numerics.max_passes = std::atoi(argv[2]);
  numerics.settled_m_per_s = numerics.settled_share = 0.0;  // never converged, so all passes are made
  numerics.work = 1'000'000'000;
  // Contacts with the floor are solved by passes, not by Newton's method.
  Rod rod(Material{}, numerics, Parts{.twist = false, .contact = true, .friction = true, .world = true}, 154);
  crumple(rod, static_cast<unsigned>(std::atoi(argv[1])), 20.0, 2.0);
  double lowest_m = 0.0;
  for (const auto& x : rod.state().x) lowest_m = std::min(lowest_m, x[2]);
  rod.has_floor = true;
  rod.floor_m = lowest_m - 0.9 * rod.material().radius_m;
  rod.tick();
  std::printf("%ld %d %d\n", rod.report().work, rod.report().passes, rod.report().contacts);
  return 0;
}
