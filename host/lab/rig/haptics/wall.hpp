#pragma once
// One axis of a device against a virtual wall, sampled as on the rig: the simplest system that can become unstable.
//
//    m v' = F_push + F - b v,   F = -(K x[n-d] + B (x[n-d] - x[n-d-1]) / T) for x[n-d] > 0, constant over each period
//
// d periods pass from the sample to the force. The mass is integrated exactly over a period (zero-order hold).

#include <cstdint>
#include <vector>

#include "protocol/device/device.hpp"

namespace ligature::lab {

struct Wall {
  double K_N_per_m = 0.0, B_N_s_per_m = 0.0;
  int delay = 1;            ///< periods from sample to force, 0 .. 3; with the controller at least 1 (the bus)
  bool two_sided = false;   ///< true: a spring instead of a wall, so that the loop is linear
  bool controller = false;  ///< true: the firmware's passivity controller is between the law and the motor
  double mass_kg = 0.045, damping_N_s_per_m = 0.3;
  double push_N = 0.0;   ///< constant push by the hand
  double start_m = 0.0;  ///< starts at rest
  double peak_N = 3.3;   ///< force limit of the motor
  // A hand that holds the device: the arm's spring (to x = 0) and damper, as in sim_device/hand.hpp. Its mass moves
  // rigidly with the device's mass.
  double hand_N_per_m = 0.0, hand_N_s_per_m = 0.0, hand_mass_kg = 0.0;
  device::Device device = device::omni();  ///< the controller's limits are those of this device

  /// A wall with mass, damping and peak force from the device record.
  [[nodiscard]] static Wall of(const device::Device& d) {
    Wall wall;
    wall.mass_kg = d.apparent_mass_kg, wall.damping_N_s_per_m = d.damping_N_s_per_m, wall.peak_N = d.peak_force_N;
    wall.device = d;
    return wall;
  }
};

struct WallRun {
  std::vector<double> x_m, f_N;  ///< position and force at each sample
  double lowest_port_J = 0.0;    ///< smallest net energy that entered the port, exact (no quantisation)
  bool finite = true;

  /// Peak-to-peak amplitude in the half second that starts at from_s.
  [[nodiscard]] double swing_m(double from_s) const;
};

[[nodiscard]] WallRun press(const Wall& wall, double time_s);

/// Whether the motion comes to rest or decays. @param time_s duration of the run; slow growth needs a long one.
[[nodiscard]] bool is_stable(const Wall& wall, double time_s = 4.0);

/// Largest stable K of the linear loop without the passivity controller, by bisection to the relative `tolerance`.
[[nodiscard]] double largest_stable_K(Wall wall, double tolerance = 0.005);

}  // namespace ligature::lab
