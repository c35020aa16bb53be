#pragma once
// Two hands that take a thread anywhere and pull with a given force.

#include <array>

#include "firmware/physics/rod/rod_simulation.hpp"
#include "host/lab/validate/specimen.hpp"

namespace ligature::published {

class TwoHands {
 public:
  TwoHands(physics::rod::RodSimulation& sim, double tick_s)
      : sim_(sim), tick_s_(tick_s), tools_(validate::no_hands()) {}

  /// Both hands let go, if they hold anything, and take the thread's nodes nearest to these points.
  void take(const validate::Vec3& left, const validate::Vec3& right);
  void let_go();
  /// One tick with these velocities, m/s.
  void tick(const validate::Vec3& left, const validate::Vec3& right);
  void rest(int ticks);
  /// Moves each hand along its direction, at most at `speed`, until the thread pulls at both with `force_N` or
  /// `most_ticks` are over. The speed falls with the missing force, so the hands stop without overshoot.
  /// @return whether the force was reached
  bool pull_to(double force_N, const std::array<validate::Vec3, 2>& directions, double speed_m_per_s, int most_ticks);
  /// Force of the thread on hand h, N, along -direction.
  [[nodiscard]] double force_N(std::size_t h, const validate::Vec3& direction) const;
  /// Distance of the two places where the hands hold the thread, m.
  [[nodiscard]] double distance_m() const;

 private:
  physics::rod::RodSimulation& sim_;
  double tick_s_;
  validate::Tools tools_;
};

}  // namespace ligature::published
