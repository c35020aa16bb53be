// Threads whose contacts were solved by sweeps that ended before they had converged.

#include <gtest/gtest.h>

#include <cmath>

#include "tests/unit/rod/crumple.hpp"

namespace ligature::test {
namespace {

constexpr unsigned kBalls = 8;  // in each test; scripts/sweep draws others

// A ball of thread thrown together, with a time step of 1/16 ms per tick. Its contacts are solved by sweeps, which do
// not converge in a single pass.
Rod unsettled_ball(unsigned seed, int passes = 1) {
  Numerics numerics;
  numerics.tick_s = 6.25e-5;
  numerics.substeps = numerics.max_substeps = 1;
  numerics.max_passes = passes;
  const Parts swept{// these parts together are solved by sweeps only
                    .twist = true, .contact = true, .friction = true, .adaptive = false, .roll = true, .turning = true};
  Material m;
  m.drag_per_s = 0.0;
  Rod rod(m, numerics, swept, 154);
  crumple(rod, seed, 20.0, 2.0);
  return rod;
}

// The remaining velocities must not close any gap by more than its width, or the overlaps would grow.
TEST(Unsettled, VelocitiesAreBrakedToWhatContactsHaveRoomFor) {
  for (unsigned seed = 1; seed <= kBalls; ++seed) {
    Rod rod = unsettled_ball(seed);
    int cut = 0;
    for (int k = 0; k < 40; ++k) {
      rod.tick();
      if (rod.report().cut_short == 0) continue;
      ++cut;
      EXPECT_GE(rod.contact_set().unsettled_fraction(rod.state().v.data(), rod.numerics().tick_s), 1.0 - 1e-6)
          << "seed " << seed << ", tick " << k;
    }
    EXPECT_GT(cut, 5);
  }
}

// A hand feels its spring and damper at the velocity v that was solved, not at the one that the brake has left: the
// sudden change of speed would be a peak of force. With the brake's factor b the node moves by b v dt.
TEST(Unsettled, HandsFeelTheVelocitiesBeforeTheBrake) {
  constexpr double kStiffness_N_per_m = 500.0, kDamping_N_s_per_m = 1.0;
  int braked = 0;
  for (unsigned seed = 1; seed <= kBalls; ++seed) {
    Rod rod = unsettled_ball(seed);
    const Vec tool = rod.state().x[77];
    rod.grip(77, kStiffness_N_per_m, kDamping_N_s_per_m, tool, false, false);
    for (int k = 0; k < 40; ++k) {
      const Vec start = rod.state().x[77];
      rod.tick();
      const double left = 1.0 - rod.report().time_lost;  // the brake's factor, as the guard does nothing
      if (left > 0.9 || left < 1e-3 || rod.report().guard_events > 0) continue;
      ++braked;
      const Vec v = (1.0 / left) * rod.state().v[77];
      const Vec force = kStiffness_N_per_m * (start + rod.numerics().tick_s * v - tool) + kDamping_N_s_per_m * v;
      EXPECT_LE(norm(rod.state().holds[0].force - force), 1e-6 * norm(force)) << "seed " << seed << ", tick " << k;
    }
  }
  RecordProperty("braked", braked);
  EXPECT_GT(braked, 20);
}

/// Sum of I w over all segments, I: moment of inertia about the axis, w: roll rate.
double roll_momentum(const Rod& rod) {
  const Material& m = rod.material();
  double sum = 0.0;
  for (std::size_t j = 0; j + 1 < rod.state().x.size(); ++j) {
    const double inertia = 0.5 * m.density_kg_per_m * m.radius_m * m.radius_m * rod.state().mesh.rest[j];
    sum += inertia * rod.spin().rate(static_cast<int>(j));
  }
  return sum;
}

// Twisting moments act on both neighbours of a vertex with opposite signs, so the roll momentum of a free thread
// changes by the torque impulses -r (t x n) . p of its contacts alone: of those that were accepted, and not of mixed
// ones that were rejected. (A single pass is never mixed.)
TEST(Unsettled, RollsByTheTorquesOfItsContacts) {
  for (unsigned seed = 1; seed <= kBalls; ++seed) {
    Rod rod = unsettled_ball(seed, 12);
    for (int k = 0; k < 40; ++k) {
      const double before = roll_momentum(rod);
      rod.tick();
      double torque = 0.0, size = 0.0;
      for (const auto& c : rod.contact_set().contacts()) {
        ASSERT_TRUE(c.is_pair());
        for (const int segment : {c.node[0], c.node[2]}) {
          const double part = -rod.material().radius_m * dot(cross(rod.spin().tangent(segment), c.n), c.p);
          torque += part, size += std::abs(part);
        }
      }
      EXPECT_NEAR(roll_momentum(rod) - before, torque, 1e-6 * size) << "seed " << seed << ", tick " << k;
    }
  }
}

}  // namespace
}  // namespace ligature::test
