#pragma once
// A hand's jaws on a rod: decides which nodes they hold, in which direction, and when the thread slips through.

#include <array>
#include <span>

#include "firmware/physics/members.hpp"
#include "firmware/physics/rod/rod.hpp"

namespace ligature::physics::rod {

struct JawSettings {
  double width_m = 0.0;                                     ///< width of the jaws; 0: they hold a single node
  double slip_N = 0.0;                                      ///< axial force above which the thread slips; 0: never
  double stiffness_N_per_m = 0.0, damping_N_s_per_m = 0.0;  ///< of the hand's coupling, shared by the nodes held
  LIGATURE_MEMBERS(JawSettings, width_m, slip_N, stiffness_N_per_m, damping_N_s_per_m)
};

/// A point on the thread's centreline.
struct Place {
  double s_m = 0.0;  ///< material coordinate
  Vec x{};
};
/// Point nearest to p on the two half segments next to a node.
[[nodiscard]] Place nearest_place(const State& state, int node, Vec p) noexcept;

/// Jaws of width w > 0 hold all nodes whose material coordinate s is within w/2 of the jaws' centre s_c, but at least
/// two. The nodes share the coupling equally. It pulls them onto a straight line along t, the thread's direction when
/// the jaws closed:
///   target_j = tool + (s_j - s_c) t,   sum_j f_j = force on the hand
/// So the jaws hold the thread's position and direction. Coulomb friction: if the coupling would pull along t by more
/// than slip_N, s_c moves until the pull is slip_N. The thread then slides, and the energy slip_N x distance is
/// dissipated. Once s_c is past the thread's end, nothing is held.
class Jaws {
 public:
  static constexpr int kMost = 4;  ///< most nodes held; if more lie between the jaws, four of them at equal intervals

  Jaws() = default;
  explicit Jaws(const JawSettings& settings) : settings_(settings) {}

  /// @param R_WT orientation of the tool, with which the thread's direction and roll then turn. nullptr: unknown; then
  /// the roll is fixed, and the direction is fixed (width > 0) or free (width 0).
  void close(Rod& rod, int node, Vec tool, const Mat* R_WT = nullptr) noexcept;
  /// Place of the thread that jaws at `tool` would hold: the nearest place beside the node, or the node itself if the
  /// jaws have no width.
  [[nodiscard]] Place would_hold(const Rod& rod, int node, Vec tool) const noexcept;
  void open(Rod& rod) noexcept;
  /// Call before each tick. Writes the target positions of the held nodes into `goals`. @param tool the tool's position
  /// at the end of the tick, m
  void follow(Rod& rod, Vec tool, std::array<Vec, kMaxHolds>& goals, const Mat* R_WT = nullptr) noexcept;
  /// Call when the rod was reset: its holds no longer exist.
  void forget() noexcept { count_ = 0; }

  [[nodiscard]] bool holds() const noexcept { return count_ > 0; }
  /// Index into State::holds of the held node nearest to the middle of the jaws. @pre holds().
  [[nodiscard]] int middle(const Rod& rod) const noexcept;
  /// Position and velocity of the thread at the jaws' centre s_c: the mean over the held nodes, each shifted along t to
  /// s_c. So, with the coupling's stiffness K and damping B,
  ///   force() = K (place - tool) + B (velocity - the tool's).
  /// @pre holds().
  [[nodiscard]] Vec place(const Rod& rod) const noexcept;
  [[nodiscard]] Vec velocity(const Rod& rod) const noexcept;
  /// Force on the hand in the last tick, N.
  [[nodiscard]] Vec force(const Rod& rod) const noexcept;
  LIGATURE_MEMBERS(Jaws, settings, hold, count, s_m, slides_m_per_s, along, turning, roll_hold, along_T, director_T)

 private:
  [[nodiscard]] std::span<const int> held() const noexcept { return {hold_.data(), static_cast<std::size_t>(count_)}; }
  void choose(Rod& rod, Vec tool) noexcept;
  void slip(Rod& rod, Vec tool) noexcept;
  void turn(Rod& rod, const Mat& R_WT) noexcept;

  JawSettings settings_;
  std::array<int, kMost> hold_{};  // indices into State::holds
  int count_ = 0;
  double s_m_ = 0.0, slides_m_per_s_ = 0.0;  // coordinate s_c of the jaws' centre on the thread; its rate by slip
  Vec along_{};
  bool turning_ = false;
  int roll_hold_ = -1;            // index of the hold whose director is director_T_
  Vec along_T_{}, director_T_{};  // direction t and the hold's director, in the tool's coordinates
};

}  // namespace ligature::physics::rod
