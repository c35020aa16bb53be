// A gripper with an orientation holds the thread's direction and roll, and turns both.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "firmware/physics/rod/rod_simulation.hpp"

namespace ligature::test {
namespace {

using physics::Hand;
using physics::ToolInput;
using physics::Vec3;
using physics::rod::RodSimulation;

constexpr double kPi = std::numbers::pi, kLength = 0.03;

/// A straight thread along x, clamped at the origin, without gravity.
RodSimulation thread(double width_m, bool rolls = false) {
  scene::Scene s;
  s.suture.model = scene::Model::kRod;
  s.suture.nodes = 31;
  s.suture.length_m = kLength;
  s.suture.radius_m = 1.5e-4;
  s.suture.rod.spacing = scene::Spacing::kUniform;
  s.suture.rod.air_drag_per_s = 30.0;
  s.suture.initial = "laid";
  s.suture.initial_polyline_m = {{0, 0, 0}, {kLength, 0, 0}};
  s.contact.turns_thread = rolls;
  s.world.gravity_m_per_s2 = {0, 0, 0};
  s.world.grippers_collide = s.world.frame_collides = false;
  s.world.fixed.push_back({0, {0, 0, 0}, scene::Vec{1, 0, 0}});
  s.hands.coupling_N_per_m = 1000.0;
  s.hands.coupling_N_s_per_m = 0.5;
  s.hands.pinch_width_m = width_m;
  auto made = RodSimulation::make(s);
  if (auto* why = std::get_if<std::string>(&made)) throw std::runtime_error(*why);
  return std::get<RodSimulation>(std::move(made));
}

/// The left hand grips the end and then turns by `angle` about `axis` in 0.5 s, `slack_m` closer to the clamp.
void turn(RodSimulation& sim, const Vec3& axis, double angle, double slack_m = 0.0) {
  std::array<ToolInput, 2> tools{};
  tools[1].p_WT = Vec3(1e3, 1e3, 1e3);
  tools[0].p_WT = sim.nodes_W().back();
  tools[0].grip = true;
  for (int k = 0; k <= 1500; ++k) {
    if (k < 100) tools[0].p_WT.x() -= slack_m / 100.0;
    tools[0].R_WT = Eigen::Quaterniond(Eigen::AngleAxisd(angle * std::min(1.0, k / 500.0), axis));
    sim.tick(tools);
  }
}

TEST(TurnedGrip, TwistsTheThreadByItsAngle) {
  for (const double width_m : {0.0, 0.004}) {
    for (const bool rolls : {false, true}) {
      auto sim = thread(width_m, rolls);
      turn(sim, Vec3(1, 0, 0), 0.75 * kPi);
      const auto& rod = sim.rod();
      const double free_m = rod.state().mesh.s[static_cast<std::size_t>(sim.hand(Hand::kLeft).node)];
      const double wanted = rod.material().GJ_N_m2 * 0.75 * kPi / (width_m > 0.0 ? free_m : kLength);
      const double tolerance = width_m > 0.0 ? 0.08 : 0.01;  // which node between the jaws holds the roll is not exact
      EXPECT_NEAR(std::abs(rod.forces().twist_moment[5]), wanted, tolerance * wanted) << width_m << rolls;
    }
  }
}

// Two whole turns, in steps small enough to be unambiguous as quaternions: the thread's twist counts them.
TEST(TurnedGrip, CountsWholeTurns) {
  auto sim = thread(0.0);
  turn(sim, Vec3(1, 0, 0), 4.0 * kPi);
  EXPECT_NEAR(std::abs(sim.rod().twist().turn_rad(0)), 4.0 * kPi, 0.02 * kPi);
}

TEST(TurnedGrip, ImposesTheDirection) {
  for (const double width_m : {0.0, 0.004}) {
    auto sim = thread(width_m);
    turn(sim, Vec3(0, 0, 1), 0.5, 0.001);  // a taut thread would bend within a millimetre of the grip
    const auto x = sim.nodes_W();
    const Vec3 end = (x[30] - x[29]).normalized();
    EXPECT_NEAR(std::atan2(end.y(), end.x()), 0.5, 0.05) << width_m;  // half a segment bends beyond the grip
    EXPECT_GT(sim.rod().energy().bend_J, 0.0);
  }
}

// Without an orientation, a grip at a single node imposes no direction: the thread stays straight.
TEST(TurnedGrip, WithoutAnOrientationAGripIsAPoint) {
  auto sim = thread(0.0);
  std::array<ToolInput, 2> tools{};
  tools[1].p_WT = Vec3(1e3, 1e3, 1e3);
  tools[0].p_WT = sim.nodes_W().back();
  tools[0].grip = true;
  for (int k = 0; k < 100; ++k) sim.tick(tools);
  EXPECT_EQ(sim.rod().state().mesh.clamp.back(), physics::rod::Clamp::kFree);
  EXPECT_NEAR(sim.rod().forces().twist_moment[5], 0.0, 1e-15);
}

}  // namespace
}  // namespace ligature::test
