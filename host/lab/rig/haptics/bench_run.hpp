#pragma once
// Runs the virtual rig and records forces and energies at the device ports.

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "host/lab/rig/virtual_rig.hpp"

namespace ligature::lab {

struct Watched {
  /// Smallest net energy that each hand has put into its port, from the motors' true work, J.
  std::array<double, 2> lowest_port_J{};
  /// Smallest value, over all ticks, of the net energy of a hand's port plus the energy that the other hand's account
  /// has lent to it, J.
  std::array<double, 2> lowest_bound_J{};
  /// Largest energy that the firmware's account can miss because encoders are quantised, J: the sum over all ticks n
  /// and joints of (encoder count in rad) |tau(n) - tau(n-1)|, tau the joint's torque (docs/haptics.md).
  std::array<double, 2> hidden_J{};
  /// Smallest value, over both ports and all ticks, of (port energy + energy lent to this hand + hidden_J so far), J.
  /// Passivity requires this value not to be negative.
  double lowest_proved_J = 0.0;
  /// Smallest difference of the two sides of the bounds of docs/passivity.md, of both ports (PortBound). These bounds
  /// hold also while frames are lost; negative: one of them did not hold.
  double least_margin_J = 0.0;
  std::array<double, 2> lowest_account_J{};  ///< the firmware's energy account, computed from encoder counts
  /// Smallest sum of the true energies of both ports; the thread transfers energy between the hands
  double lowest_sum_J = 0.0;
  double peak_N = 0.0;
  /// Largest change of the motors' tip force per SYNC, apart from removals of the whole force.
  double largest_step_N = 0.0;
  /// Largest change where the whole force is removed at once: by a fault, or when a hand is let go (its force is
  /// dropped for lack of energy).
  double largest_cut_N = 0.0;
  /// How often a hand was let go without a fault, from a force above the step limit.
  int let_go = 0;
  int fault = 0;
  std::vector<std::array<double, 2>> tip_force_N;    ///< magnitude of the motors' force at each tip, per tick
  std::vector<std::array<sim::Vec3, 2>> rendered_N;  ///< the motors' force at each tip as vectors, per tick
  std::vector<std::array<double, 2>> port_J;
  std::vector<std::array<double, 2>> step_N;  ///< change of that force at each SYNC
  std::vector<sim::Vec3> nodes_W;             ///< thread's nodes at tick look_at
  std::vector<float> tension_N;               ///< tension per node at that tick

  /// rms of the force's components above 30 Hz (first-order high-pass, applied twice) over ticks first .. last.
  [[nodiscard]] double chatter_N(std::size_t hand, std::size_t first, std::size_t last) const;
  [[nodiscard]] sim::Vec3 mean_N(std::size_t hand, std::size_t first, std::size_t last) const;
  /// rms deviation of the force from its mean, larger value of the two hands.
  [[nodiscard]] double unrest_N(std::size_t first, std::size_t last) const;
  /// chatter_N() over the whole run after the first 0.5 s, larger value of the two hands.
  [[nodiscard]] double worst_chatter_N() const;
  /// Computes largest_step_N, largest_cut_N and let_go from step_N and the loop's records.
  void sort_steps(const std::vector<rt::TickRecord>& records);
};

/// Runs the rig. @param look_at tick at which the thread's shape is recorded.
[[nodiscard]] Watched watch(VirtualRig& rig, std::int64_t ticks, std::size_t look_at = 0);

}  // namespace ligature::lab
