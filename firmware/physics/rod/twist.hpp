#pragma once
// Twist of the thread between the places that hold its roll, quasi-static.

#include <array>

#include "firmware/physics/rod/state.hpp"

namespace ligature::physics::rod {

/// Between two places that hold roll the twist is uniform (a twist wave crosses 0.3 m of nylon in 0.4 ms, faster than a
/// tick), so one angle a span tells all of it [Bergou 2008, quasi-static material frame]:
///   E = C Theta^2 / 2 L,   M = C Theta / L,
/// Theta the angle from the director of one end, transported along the centreline by the Bishop (parallel) frame, to
/// that of the other; it counts whole turns. A span with a free end has M = 0. The force on the centreline is
/// -M grad(Theta), from the vertex binormals (assembly.cpp).
class Twist {
 public:
  /// Starts holding roll at a hold, without changing the twist anywhere.
  void attach(State& state, int hold) noexcept;
  void detach(State& state, int hold) noexcept;

  /// Turns a hold's director about its tangent by angle_rad (a gripper that rolls the thread).
  static void roll(Hold& hold, double angle_rad) noexcept;

  /// Directors of all holds go along with their tangents, or with the hand that steers them.
  void carry(State& state) const noexcept;

  /// Once a tick: carries directors along with the tangents, measures every span and writes M into forces.
  /// O(n), no allocation. Valid while no span turns half a revolution in a tick.
  void update(const Material& material, State& state, Forces& forces) noexcept;

  [[nodiscard]] double energy_J() const noexcept { return energy_J_; }
  [[nodiscard]] int spans() const noexcept { return count_ > 0 ? count_ - 1 : 0; }
  [[nodiscard]] double turn_rad(int span) const noexcept { return turn_[static_cast<std::size_t>(span)]; }
  [[nodiscard]] double moment_Nm(int span) const noexcept { return moment_[static_cast<std::size_t>(span)]; }

 private:
  [[nodiscard]] double raw_turn(const State& state, int from, int to) const noexcept;

  std::array<int, kMaxHolds> order_{};    // holds by node
  std::array<double, kMaxHolds> turn_{};  // of the span after order_[k]
  std::array<double, kMaxHolds> moment_{};
  int count_ = 0;
  double energy_J_ = 0.0;
};

/// Unit tangent of the thread where it is held.
[[nodiscard]] Vec tangent_at(const State& state, const Hold& hold) noexcept;

/// The least rotation that takes unit a to unit b, applied to u.
[[nodiscard]] inline Vec transport(Vec u, Vec a, Vec b) noexcept {
  const double c = dot(a, b);
  const Vec axis = cross(a, b);
  return c * u + cross(axis, u) + (dot(axis, u) / (1.0 + c)) * axis;
}

}  // namespace ligature::physics::rod
