#pragma once
// One axis of a device against a virtual wall, sampled as the rig samples: the smallest thing that can go unstable.
//
//   m v' = F_push + F - b v,   F = -(K x[n-d] + B (x[n-d] - x[n-d-1]) / T) for x[n-d] > 0, constant over each period
//
// d periods pass from the sample to the force. The mass is moved exactly over a period (zero-order hold).

#include <cstdint>
#include <vector>

#include "protocol/device/device.hpp"

namespace ligature::lab {

struct Wall {
  double K_N_per_m = 0.0, B_N_s_per_m = 0.0;
  int delay = 1;            ///< periods, 0 .. 3; with the controller at least 1: the wire's own
  bool two_sided = false;   ///< a spring instead of a wall: the loop is linear
  bool controller = false;  ///< the firmware's passivity controller stands between the law and the motor
  double mass_kg = 0.045, damping_N_s_per_m = 0.3;
  double push_N = 0.0;   ///< a steady hand
  double start_m = 0.0;  ///< starts at rest
  double peak_N = 3.3;   ///< what the motor can do
  // A hand on the device: its arm's spring and damper (to x = 0), as in sim_device/hand.hpp but without mass.
  double hand_N_per_m = 0.0, hand_N_s_per_m = 0.0, hand_mass_kg = 0.0;
  device::Device device = device::omni();  ///< whose limits the controller keeps

  /// With the mass, damping and peak force that the record says.
  [[nodiscard]] static Wall of(const device::Device& d) {
    Wall wall;
    wall.mass_kg = d.apparent_mass_kg, wall.damping_N_s_per_m = d.damping_N_s_per_m, wall.peak_N = d.peak_force_N;
    wall.device = d;
    return wall;
  }
};

struct WallRun {
  std::vector<double> x_m, f_N;  ///< at each sample
  double lowest_port_J = 0.0;    ///< least energy the port has taken in, exact (no counts)
  bool finite = true;

  /// Peak to peak from `from_s` on, for a window of half a second.
  [[nodiscard]] double swing_m(double from_s) const;
};

[[nodiscard]] WallRun press(const Wall& wall, double time_s);

/// Comes to rest, or swings less and less. @param time_s of the run; a slow growth needs a long one.
[[nodiscard]] bool is_stable(const Wall& wall, double time_s = 4.0);

/// Largest stable K of a linear, uncontrolled loop, by bisection to `tolerance` of K.
[[nodiscard]] double largest_stable_K(Wall wall, double tolerance = 0.005);

}  // namespace ligature::lab
