#pragma once
// State of a rod: positions, velocities, holds, and the internal forces of the last substep. Allocated once.

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "firmware/physics/members.hpp"
#include "firmware/physics/rod/mesh/mesh.hpp"
#include "firmware/physics/rod/vec.hpp"

namespace ligature::physics::rod {

/// A constraint on one node: a support of the scene, or a hand's gripper.
struct Hold {
  int node = -1;                                            ///< -1: this slot is unused
  bool rigid = false;                                       ///< position imposed (support) instead of a spring (hand)
  bool directed = false;                                    ///< imposes the tangent too
  bool holds_roll = false;                                  ///< fixes the thread's rotation about its axis
  double stiffness_N_per_m = 0.0, damping_N_s_per_m = 0.0;  ///< of a hand's coupling
  Vec target{}, velocity{};  ///< position of the holder at the end of the substep, m, and its velocity, m/s
  Vec force{};               ///< on the holder, N, in the last substep; 0 if rigid
  Vec direction{};           ///< if directed: the imposed unit tangent
  Vec director{};            ///< if holds_roll: unit normal fixed to the thread's material here
  Vec tangent{};             ///< unit tangent to which the director is perpendicular
  bool steered = false;      ///< the director follows `steer`, projected perpendicular to the tangent
  Vec steer{};
  LIGATURE_MEMBERS(Hold, node, rigid, directed, holds_roll, stiffness_N_per_m, damping_N_s_per_m, target, velocity,
                   force, direction, director, tangent, steered, steer)
};

inline constexpr int kMaxHolds = 16;

struct State {
  Mesh mesh;
  std::vector<Vec> x, v;                      ///< n positions, m, and velocities, m/s
  std::vector<Vec> load;                      ///< n constant forces, N
  std::vector<Vec> rest_bend;                 ///< n: stress-free part of the bend t_i - t_{i-1}
  std::vector<double> cut_before, cut_after;  ///< h and h' of segment j's smooth curve, 0 .. 1 (smooth.hpp)
  std::vector<double> rest_strain;            ///< n - 1 (sized n): stress-free part of the strain l / l_rest - 1
  std::array<Hold, kMaxHolds> holds;
  int hold_count = 0;

  [[nodiscard]] int nodes() const noexcept { return mesh.nodes(); }
  /// Holds, among them unused slots.
  [[nodiscard]] std::span<Hold> slots() noexcept {
    return std::span(holds).first(static_cast<std::size_t>(hold_count));
  }
  [[nodiscard]] std::span<const Hold> slots() const noexcept {
    return std::span(holds).first(static_cast<std::size_t>(hold_count));
  }
  [[nodiscard]] bool is_held(int node) const noexcept {
    return std::ranges::any_of(slots(), [&](const Hold& hold) { return hold.node == node; });
  }
  /// Tangent of segment j, with its stretch: length l / l_rest.
  [[nodiscard]] Vec tangent(std::size_t j) const noexcept { return mesh.inv_rest[j] * (x[j + 1] - x[j]); }
  /// Strain l / l_rest - 1 of segment j, and without its stress-free part.
  [[nodiscard]] double strain(std::size_t j) const noexcept { return norm(x[j + 1] - x[j]) * mesh.inv_rest[j] - 1.0; }
  [[nodiscard]] double elastic_strain(std::size_t j) const noexcept { return strain(j) - rest_strain[j]; }
  /// Bend t_i - t_{i-1} of vertex i, and without its stress-free part. @pre 0 < i < n - 1.
  [[nodiscard]] Vec bend(std::size_t i) const noexcept { return tangent(i) - tangent(i - 1); }
  [[nodiscard]] Vec elastic_bend(std::size_t i) const noexcept { return bend(i) - rest_bend[i]; }
  void resize(int n) {
    mesh.resize(n);
    for (auto* array : {&x, &v, &load, &rest_bend}) array->assign(static_cast<std::size_t>(n), Vec{});
    rest_strain.assign(static_cast<std::size_t>(n), 0.0);
    for (auto* array : {&cut_before, &cut_after}) array->assign(static_cast<std::size_t>(n), 0.5);
  }
  LIGATURE_MEMBERS(State, mesh, x, v, load, rest_bend, cut_before, cut_after, rest_strain, holds, hold_count)
};

/// Internal forces, as computed when the linear system of the last substep was assembled.
struct Forces {
  std::vector<Vec> tangent, unit;  ///< e_j / l_j and e_j / |e_j|
  std::vector<Vec> moment_in,
      moment_out;                    ///< moment of vertex i on the segments before and after it, N m
  std::vector<Vec> edge;             ///< force of segment j on node j, N (on node j + 1: the opposite)
  std::vector<double> shortening;    ///< l_rest / |e|
  std::vector<double> tension;       ///< EA strain, N
  std::vector<double> twist_moment;  ///< twisting moment M at vertex i, N m
  std::vector<double> half_twist;    ///< M / (1 + cos a) at vertex i, a the angle between its segments

  void resize(int n) {
    const auto size = static_cast<std::size_t>(n);
    for (auto* array : {&tangent, &unit, &moment_in, &moment_out, &edge}) array->assign(size, Vec{});
    shortening.assign(size, 1.0);
    tension.assign(size, 0.0);
    twist_moment.assign(size, 0.0);
    half_twist.assign(size, 0.0);
  }
  LIGATURE_MEMBERS(Forces, tangent, unit, moment_in, moment_out, edge, shortening, tension, twist_moment, half_twist)
};

}  // namespace ligature::physics::rod
