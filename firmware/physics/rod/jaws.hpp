#pragma once
// A hand's jaws on a rod: what they hold, how straight, and when the thread slips through.

#include <array>

#include "firmware/physics/rod/rod.hpp"

namespace ligature::physics::rod {

struct JawSettings {
  double width_m = 0.0;                                     ///< 0: a single node
  double slip_N = 0.0;                                      ///< pull along the thread that jaws withstand; 0: any
  double stiffness_N_per_m = 0.0, damping_N_s_per_m = 0.0;  ///< of the hand's coupling, shared by the nodes held
};

/// A place of the thread.
struct Place {
  double s_m = 0.0;  ///< material coordinate
  Vec x{};
};
/// Nearest to p on the half segments beside a node.
[[nodiscard]] Place nearest_place(const State& state, int node, Vec p) noexcept;

/// Jaws of width w hold the nodes whose material coordinate s lies within w/2 of the place s_c between them, two at
/// least, each by its share of the coupling, on a straight line that keeps the direction t it had when they closed:
///   target_j = tool + (s_j - s_c) t,   sum_j f_j = force on the hand
/// so that they hold position and direction. Coulomb: when the coupling would pull along t by more than slip_N, s_c
/// moves until it pulls by slip_N; the thread slides, and what is lost is slip_N times the way. Off the thread's end
/// nothing is held any more.
class Jaws {
 public:
  static constexpr int kMost = 4;  ///< nodes held; of more, four spread evenly

  Jaws() = default;
  explicit Jaws(const JawSettings& settings) : settings_(settings) {}

  /// @param R_WT  how the tool is turned, nullptr when nobody knows: then the direction stays as it is (width > 0) or
  /// free, and the thread cannot roll. With it, direction and roll turn as the tool does.
  void close(Rod& rod, int node, Vec tool, const Mat* R_WT = nullptr) noexcept;
  /// What jaws at `tool` would hold: across a width any place beside the node, else the node.
  [[nodiscard]] Place would_hold(const Rod& rod, int node, Vec tool) const noexcept;
  void open(Rod& rod) noexcept;
  /// Before each tick: the tool will be here at its end. Fills the goals of the holds.
  void follow(Rod& rod, Vec tool, std::array<Vec, kMaxHolds>& goals, const Mat* R_WT = nullptr) noexcept;
  /// The rod was put back to its start.
  void forget() noexcept { count_ = 0; }

  [[nodiscard]] bool holds() const noexcept { return count_ > 0; }
  /// Index into State::holds of the node nearest to the middle. @pre holds().
  [[nodiscard]] int middle(const Rod& rod) const noexcept;
  /// Where the thread between the jaws is, and how it moves: of what is held, each node brought to s_c along t, so that
  ///   force() = K (place - tool) + B (velocity - the tool's).
  /// No node need lie at s_c, and nodes that share a couple stand to either side of it. @pre holds().
  [[nodiscard]] Vec place(const Rod& rod) const noexcept;
  [[nodiscard]] Vec velocity(const Rod& rod) const noexcept;
  /// On the hand, N, of the last tick.
  [[nodiscard]] Vec force(const Rod& rod) const noexcept;

 private:
  void choose(Rod& rod, Vec tool) noexcept;
  void slip(Rod& rod, Vec tool) noexcept;
  void turn(Rod& rod, const Mat& R_WT) noexcept;

  JawSettings settings_;
  std::array<int, kMost> hold_{};  // indices into State::holds
  int count_ = 0;
  double s_m_ = 0.0, slides_m_per_s_ = 0.0;  // slides: s_c
  Vec along_{};
  bool turning_ = false;
  int roll_hold_ = -1;            // the one whose director is director_T_
  Vec along_T_{}, director_T_{};  // in the tool's frame, since the jaws closed
};

}  // namespace ligature::physics::rod
