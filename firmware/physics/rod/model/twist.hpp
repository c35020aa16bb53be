#pragma once
// Quasi-static twist of the thread between the holds that fix its roll.

#include <array>
#include <cmath>
#include <cstddef>

#include "firmware/physics/members.hpp"
#include "firmware/physics/rod/model/state.hpp"

namespace ligature::physics::rod {

/// Twist between two holds that fix roll (a span). It is uniform, because a twist wave crosses 0.3 m of nylon in 0.4
/// ms, less than a tick. So one angle Theta describes it [Bergou 2008, quasi-static material frame]. With the length L
/// and the twisting stiffness C, the energy E and the twisting moment M of the span are
///   E = C Theta^2 / (2 L),   M = C Theta / L.
/// Theta is the angle, whole turns included, from the director at one end, parallel-transported along the centreline,
/// to the director at the other end. A span with a free end has M = 0. The force on the centreline is -M grad(Theta),
/// computed from the curvature binormals of the vertices (assembly.cpp).
class Twist {
 public:
  /// Fixes the roll at a hold, without changing the twist anywhere.
  void attach(State& state, int hold) noexcept;
  void detach(State& state, int hold) noexcept;

  /// Turns a hold's director about the tangent by angle_rad, as a gripper does that rolls the thread.
  static void roll(Hold& hold, double angle_rad) noexcept;

  /// Updates the directors of all holds: by parallel transport to the new tangent, or to the direction that a hand
  /// steers.
  void carry(State& state) const noexcept;

  /// Call once per tick. Calls carry(), computes the twist angle of every span, and writes the twisting moments M to
  /// `forces`. Valid only if no span twists by half a revolution or more in one tick. O(n), no allocation.
  void update(const Material& material, State& state, Forces& forces) noexcept;

  [[nodiscard]] double energy_J() const noexcept { return energy_J_; }
  [[nodiscard]] double turn_rad(int span) const noexcept { return turn_[span]; }
  [[nodiscard]] double moment_Nm(int span) const noexcept { return moment_[span]; }
  LIGATURE_MEMBERS(Twist, order, turn, moment, count, energy_J)

 private:
  [[nodiscard]] double raw_turn(const State& state, int from, int to) const noexcept;

  std::array<int, kMaxHolds> order_{};    // holds that fix roll, in the order of their nodes
  std::array<double, kMaxHolds> turn_{};  // Theta of the span after order_[k]
  std::array<double, kMaxHolds> moment_{};
  int count_ = 0;
  double energy_J_ = 0.0;
};

/// Unit tangent of segment j.
[[nodiscard]] inline Vec edge(const State& state, std::size_t j) noexcept { return unit(state.x[j + 1] - state.x[j]); }

/// The vector `across`, turned by the angle, rad, about the unit vector `axis`. @pre the two are perpendicular.
[[nodiscard]] inline Vec rolled(Vec across, Vec axis, double angle) noexcept {
  return std::cos(angle) * across + std::sin(angle) * cross(axis, across);
}

/// Angle about `axis` from one vector to the other, rad, in -pi to pi. @pre both are perpendicular to the axis.
[[nodiscard]] inline double angle_about(Vec axis, Vec from, Vec to) noexcept {
  return std::atan2(dot(axis, cross(from, to)), dot(from, to));
}

/// Unit tangent of the thread where it is held.
[[nodiscard]] Vec tangent_at(const State& state, const Hold& hold) noexcept;

/// The vector u, turned by the smallest rotation that turns the unit vector a into the unit vector b.
[[nodiscard]] inline Vec transport(Vec u, Vec a, Vec b) noexcept {
  const double c = dot(a, b);
  const Vec axis = cross(a, b);
  return c * u + cross(axis, u) + (dot(axis, u) / (1.0 + c)) * axis;
}

}  // namespace ligature::physics::rod
