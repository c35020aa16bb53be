#pragma once
// Quasi-static twist of the thread between the holds that fix its roll.

#include <array>

#include "firmware/physics/members.hpp"
#include "firmware/physics/rod/model/state.hpp"

namespace ligature::physics::rod {

/// Between two holds that fix roll (a span) the twist is uniform, because a twist wave crosses 0.3 m of nylon in 0.4
/// ms, less than a tick. So one angle Theta per span describes it [Bergou 2008, quasi-static material frame], with the
/// energy E and the twisting moment M of a span of length L and twisting stiffness C:
///   E = C Theta^2 / 2 L,   M = C Theta / L.
/// Theta is the angle from the director at one end, transported along the centreline by the Bishop (parallel) frame, to
/// the director at the other end, whole turns included. A span with a free end has M = 0. The force on the centreline
/// is -M grad(Theta), computed from the vertex binormals (assembly.cpp).
class Twist {
 public:
  /// Fixes the roll at a hold, without changing the twist anywhere.
  void attach(State& state, int hold) noexcept;
  void detach(State& state, int hold) noexcept;

  /// Turns a hold's director about its tangent by angle_rad (a gripper that rolls the thread).
  static void roll(Hold& hold, double angle_rad) noexcept;

  /// Updates the directors of all holds: parallel transport to the new tangent, or the hand's direction if steered.
  void carry(State& state) const noexcept;

  /// Once per tick: carry(), then computes the twist angle of every span, and writes the twisting moments M to
  /// `forces`. O(n), no allocation. Valid while no span turns by half a revolution or more in one tick.
  void update(const Material& material, State& state, Forces& forces) noexcept;

  [[nodiscard]] double energy_J() const noexcept { return energy_J_; }
  [[nodiscard]] int spans() const noexcept { return count_ > 0 ? count_ - 1 : 0; }
  [[nodiscard]] double turn_rad(int span) const noexcept { return turn_[static_cast<std::size_t>(span)]; }
  [[nodiscard]] double moment_Nm(int span) const noexcept { return moment_[static_cast<std::size_t>(span)]; }
  LIGATURE_MEMBERS(Twist, order, turn, moment, count, energy_J)

 private:
  [[nodiscard]] double raw_turn(const State& state, int from, int to) const noexcept;

  std::array<int, kMaxHolds> order_{};    // holds that fix roll, in the order of their nodes
  std::array<double, kMaxHolds> turn_{};  // Theta of the span after order_[k]
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
