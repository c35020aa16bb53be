#pragma once
// A run of the virtual rig watched at its ports.

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "host/lab/rig/virtual_rig.hpp"

namespace ligature::lab {

struct Watched {
  std::array<double, 2> lowest_port_J{};   ///< least the hand has put into the rig, by the motors' true work
  std::array<double, 2> lowest_bound_J{};  ///< the same plus what the other hand's account gave it
  std::array<double, 2> hidden_J{};        ///< that counts can hide: sum of count |tau(n) - tau(n-1)| (docs/haptics.md)
  double lowest_proved_J = 0.0;            ///< least of either port's bound and what had been hidden until then
  std::array<double, 2> lowest_account_J{};  ///< the firmware's account, on counts
  double lowest_sum_J = 0.0;                 ///< of both ports' true energy: the thread carries it from hand to hand
  double peak_N = 0.0;
  double largest_step_N = 0.0;  ///< of what the motors make at a tip, SYNC by SYNC, but where all goes at once:
  double largest_cut_N = 0.0;   ///< by a fault, or where a hand is let go
  int let_go = 0;               ///< how often one was, without a fault, from more than a step
  int fault = 0;
  std::vector<std::array<double, 2>> tip_force_N;    ///< magnitude of what the motors make at each tip, a tick
  std::vector<std::array<sim::Vec3, 2>> rendered_N;  ///< the same as vectors
  std::vector<std::array<double, 2>> port_J;
  std::vector<std::array<double, 2>> step_N;  ///< change of that force at the SYNC before
  std::vector<sim::Vec3> nodes_W;             ///< at tick look_at
  std::vector<float> tension_N;               ///< then, by node

  /// rms of the force's components above 30 Hz (first-order high-pass, twice) and mean magnitude, of ticks first ..
  /// last.
  [[nodiscard]] double chatter_N(std::size_t hand, std::size_t first, std::size_t last) const;
  [[nodiscard]] sim::Vec3 mean_N(std::size_t hand, std::size_t first, std::size_t last) const;
  /// rms of the force's change about its mean, worse hand.
  [[nodiscard]] double unrest_N(std::size_t first, std::size_t last) const;
  /// Peak to peak speedless measure of trouble: rms of chatter over the whole run, worse hand.
  [[nodiscard]] double worst_chatter_N() const;
  /// Fills in what is measured of steps.
  void sort_steps(const std::vector<rt::TickRecord>& records);
};

/// Runs and watches. @param look_at tick at which the thread's shape is kept.
[[nodiscard]] Watched watch(VirtualRig& rig, std::int64_t ticks, std::size_t look_at = 0);

}  // namespace ligature::lab
