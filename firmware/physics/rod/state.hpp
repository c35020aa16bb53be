#pragma once
// How a rod moves, what holds it, and the scratch of its laws. Sized once.

#include <array>
#include <vector>

#include "firmware/physics/rod/mesh.hpp"
#include "firmware/physics/rod/vec.hpp"

namespace ligature::physics::rod {

/// Something that holds a node: a support of the scene, or a hand's gripper.
struct Hold {
  int node = -1;                                            ///< -1: holds nothing
  bool rigid = false;                                       ///< position imposed (support) instead of a spring (hand)
  bool directed = false;                                    ///< imposes the tangent too
  bool holds_roll = false;                                  ///< the thread cannot turn about its axis here
  double stiffness_N_per_m = 0.0, damping_N_s_per_m = 0.0;  ///< of a hand's coupling
  Vec target{}, velocity{};  ///< where the holder is at the end of the substep, m, and how it moves
  Vec force{};               ///< on the holder, N, of the last substep
  Vec direction{};           ///< unit tangent imposed, when directed
  Vec director{};            ///< unit normal glued to the thread here, when holds_roll
  Vec tangent{};             ///< unit tangent the director belongs to
  bool steered = false;  ///< the holder turns the thread: the director is what is next to `steer` across the tangent
  Vec steer{};
};

inline constexpr int kMaxHolds = 16;

struct State {
  Mesh mesh;
  std::vector<Vec> x, v;                      ///< n positions, m, and velocities, m/s
  std::vector<Vec> load;                      ///< n constant forces, N
  std::vector<Vec> rest_bend;                 ///< n: part of t_i - t_{i-1} that is stress free
  std::vector<double> cut_before, cut_after;  ///< of segment j, how far the corners at j and j + 1 are cut (smooth.hpp)
  std::vector<double> rest_strain;            ///< n - 1 (sized n): part of l / l_rest - 1 that is stress free
  std::array<Hold, kMaxHolds> holds;
  int hold_count = 0;

  [[nodiscard]] int nodes() const noexcept { return mesh.nodes(); }
  void resize(int n) {
    mesh.resize(n);
    for (auto* array : {&x, &v, &load, &rest_bend}) array->assign(static_cast<std::size_t>(n), Vec{});
    rest_strain.assign(static_cast<std::size_t>(n), 0.0);
    for (auto* array : {&cut_before, &cut_after}) array->assign(static_cast<std::size_t>(n), 0.5);
  }
};

/// Forces of the last assembly, kept for those who measure.
struct Forces {
  std::vector<Vec> tangent, unit;  ///< e_j / l_j and e_j / |e_j|
  std::vector<Vec> moment_in,
      moment_out;                    ///< of vertex i on the segment before and after it, N m: bending -+ half twist
  std::vector<Vec> edge;             ///< P_j: the force segment j exerts on node j (and - on j + 1)
  std::vector<double> shortening;    ///< l_rest / |e|
  std::vector<double> tension;       ///< EA strain, N
  std::vector<double> twist_moment;  ///< M of vertex i, N m
  std::vector<double> half_twist;    ///< M / (1 + cos) of the angle there

  void resize(int n) {
    const auto size = static_cast<std::size_t>(n);
    for (auto* array : {&tangent, &unit, &moment_in, &moment_out, &edge}) array->assign(size, Vec{});
    shortening.assign(size, 1.0);
    tension.assign(size, 0.0);
    twist_moment.assign(size, 0.0);
    half_twist.assign(size, 0.0);
  }
};

}  // namespace ligature::physics::rod
