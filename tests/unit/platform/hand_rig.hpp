#pragma once
// The real control law and protocol class of one hand with simulated drives, in simulated time: what happens to the
// torque when something goes wrong. docs/drives.md has the results.

#include <gtest/gtest.h>

#include <cstdio>
#include <functional>
#include <numbers>
#include <string>

#include "tests/unit/control/controller_rig.hpp"
#include "tests/unit/platform/simulated_hand.hpp"

namespace ligature::platform {

/// The left hand has simulated drives; the right one needs none.
template <class Hand>
class HandRig {
 public:
  template <class... Settings>
  explicit HandRig(const Settings&... settings) : left(settings...), law(control::Rig::scene(), left.device) {
    for (std::size_t j = 0; j < 3; ++j)
      left.nodes[j].position_rev = static_cast<float>(law.in.reading.hand[1].q_rad[j] / (2.0 * std::numbers::pi));
    left.buttons.bits = 0;
    left.wait.on_wait = [this] {
      left.advance();
      if (left.torque() > 0.0F) pushed_at = left.wait.time;
    };
  }
  void period() {
    if (!is_silent) left.drives.request();
    const Nanoseconds end = left.wait.time + std::chrono::milliseconds(1);
    while (left.wait.time < end) {
      left.wait.wait(end);
      if (!is_silent) left.drives.drain();
    }
    if (is_silent) return;
    law.in.reading.hand[0] = left.drives.reading();
    for (std::size_t h = 0; h < 2; ++h) law.in.grasp[h].p_WG = law.controller.hand(h).p_WT + control::Vec3(0, 0, 0.05);
    const auto command = law.controller.tick(law.in);
    ++law.in.tick;
    left.drives.write(command.hand[0]);
  }
  void periods(int n) {
    for (int i = 0; i < n; ++i) period();
  }

  Hand left;
  control::Rig law;
  Nanoseconds pushed_at{0};  // the last time at which a motor had torque
  bool is_silent = false;    // the controller has died
};

/// A cause, the fault that it shall become, and the longest time for which a motor may have torque after it.
template <class Hand>
struct Cause {
  const char* name;
  std::function<void(HandRig<Hand>&)> happens;
  control::Fault fault;
  int within_ms;
};

/// Lets the cause happen while the drives make torque.
template <class Hand>
void measure(HandRig<Hand>& rig, const Cause<Hand>& cause, const std::string& remark = {}) {
  ASSERT_EQ(rig.left.start(), "accepted") << cause.name;
  rig.left.buttons.bits = 0;
  rig.periods(150);
  rig.left.buttons.bits = 2;
  rig.periods(850);
  ASSERT_GT(rig.left.torque(), 0.0F) << cause.name;
  const Nanoseconds onset = rig.left.wait.time;
  cause.happens(rig);
  rig.periods(300);
  const double ms = std::chrono::duration<double, std::milli>(rig.pushed_at - onset).count();
  std::printf("%-50s fault %2d, torque for %.1f ms%s\n", cause.name, static_cast<int>(rig.law.controller.fault()), ms,
              remark.c_str());
  EXPECT_EQ(rig.law.controller.fault(), cause.fault) << cause.name;
  EXPECT_LE(ms, cause.within_ms) << cause.name;
  EXPECT_EQ(rig.left.torque(), 0.0F) << cause.name;
}

}  // namespace ligature::platform
