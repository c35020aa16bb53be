#pragma once
// Fixture: the control law without drives. The test sets the encoder readings and the positions of the held nodes.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "firmware/control/controller.hpp"

namespace ligature::control {

inline constexpr int kWatchdog = 20;

/// A controller with two resting hands; each holds a node 5 cm above its tool and presses the dead-man as soon as a
/// press is accepted.
class Rig {
 public:
  explicit Rig(const scene::Hands& hands = scene(), const device::Device& device = device::omni(),
               std::int32_t watchdog_ticks = kWatchdog)
      : controller(hands, {watchdog_ticks, true, device}) {
    for (std::size_t h = 0; h < rt::kHands; ++h) {
      auto& r = in.reading.hand[h];
      r.q_rad = {0.0, 0.5, 0.6};
      r.valid = r.enabled = r.dead_man = true;
      in.grasp[h].held = true;
    }
  }

  static scene::Hands scene() {
    scene::Hands hands;
    hands.workspace_scale = 20.0;
    hands.energy_credit_J = 0.02;  // these hands never move, so they earn no energy credit
    return hands;
  }

  /// A Cartesian device of three cable drums: the force that its torques make does not depend on its pose.
  static device::Device drums() {
    device::Device d = device::omni();
    d.kinematics = device::Kinematics::kCartesian;
    d.links_m = {0.15, 0.15, 0.15};
    return d;
  }

  rt::RigCommand tick() {
    for (std::size_t h = 0; h < rt::kHands; ++h) in.grasp[h].p_WG = controller.hand(h).p_WT + Vec3(0, 0, offset_m);
    return tick_as_is();
  }
  /// A tick with the grasps exactly as the test has set them.
  rt::RigCommand tick_as_is() {
    TickInput now = in;
    for (auto& hand : now.reading.hand) hand.dead_man = hand.dead_man && released >= DeadMan::kReleased;
    if (released < DeadMan::kReleased) ++released;
    const auto command = controller.tick(now);
    ++in.tick;
    return command;
  }
  void ticks(int n) {
    for (int i = 0; i < n; ++i) tick();
  }
  void to_force() {
    ticks(1000);
    ASSERT_EQ(controller.state(), State::kForce);
    ASSERT_GT(largest(tick()), 0.0);
  }
  /// Raises the force to a hand's maximum; that takes many ticks of the step limit.
  void pull_hard() {
    offset_m = 50.0;
    ticks(40);
    ASSERT_GT(controller.hand(0).f_device_N.norm(), 2.6);
  }
  static double largest(const rt::RigCommand& c) {
    double most = 0.0;
    for (const auto& hand : c.hand) {
      for (const double t : hand.torque_Nm) most = std::max(most, std::abs(t));
    }
    return most;
  }

  Controller controller;
  TickInput in;
  double offset_m = 0.05;
  int released = 0;  ///< ticks since the dead-man was released; the test sets 0 to release it again
};

}  // namespace ligature::control
