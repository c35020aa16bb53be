#pragma once
// Parameters of a haptic device. Files: scenes/devices/*.toml (read by device_file.hpp). SI units; D is the device's
// base frame (x right, y away from the person, z up), T the tip.

#include <array>
#include <cstdint>
#include <numbers>
#include <optional>
#include <string>

#include "protocol/device/cia402_profile.hpp"
#include "protocol/device/odrive_profile.hpp"

namespace ligature::device {

using Vec = std::array<double, 3>;

/// Kind of linkage: selects the function from joint angles to the tip. Firmware and simulated device implement each one
/// separately.
enum class Kinematics : std::uint8_t {
  kOmniSerial,  ///< waist, shoulder, forearm driven from the base: links[0] upper arm, links[1] forearm
  kCartesian,   ///< three linear axes, each pulled by a drum: links[i] = drum radius, p = home + links * q
};

/// Origin of a value.
enum class Source : std::uint8_t { kAssumed, kDatasheet, kMeasured };

struct Device {
  std::string name;
  Kinematics kinematics = Kinematics::kOmniSerial;

  // Geometry.
  Vec links_m{};
  Vec home_tip_m{};  ///< tip position that maps to the scene's workspace_origin_m
  /// Joint stops, rad. For the Omni's third joint they limit the angle between the links, q3 - q2.
  Vec joint_min_rad{}, joint_max_rad{};
  Vec workspace_min_m{}, workspace_max_m{};  ///< box in D within which the tip is used

  // Drives; values refer to the joint.
  int motor_counts = 0;                   ///< encoder counts per motor revolution, after quadrature
  double gear = 1.0;                      ///< motor revolutions per joint revolution
  double rated_torque_Nm = 0.0;           ///< rated torque of a drive at the joint (object 0x6076)
  int max_torque_permille = 0;            ///< largest torque, per mille of the rated one (object 0x6072)
  int torque_tolerance_permille = 50;     ///< a drive's reported torque may exceed the commanded one by this
  double delay_s = 0.0;                   ///< from a position sample to the effect of the torque computed from it
  Cia402Profile cia402{};                 ///< what CiA 402 drives offer on the bus
  std::optional<OdriveProfile> odrive{};  ///< set: the drives are ODrives, and cia402 means nothing
  bool moteus = false;                    ///< the drives are moteus controllers, and cia402 means nothing

  // Passive dynamics of the device when it is off, at the tip in the home pose.
  double apparent_mass_kg = 0.0;
  double damping_N_s_per_m = 0.0;  ///< viscous damping b
  double coulomb_N = 0.0;

  // Limits.
  double peak_force_N = 0.0;
  double continuous_force_N = 0.0;
  double thermal_time_s = 0.0;  ///< thermal time constant of the motors' windings
  double velocity_limit_m_per_s = 0.0;
  double force_step_N = 0.0;        ///< largest change within one period
  double force_slew_N_per_s = 0.0;  ///< largest rate of change over many periods
  /// Largest acceleration that a hand gives the tip, assumed by the passivity controller
  double hand_acceleration_m_per_s2 = 0.0;

  [[nodiscard]] double counts_per_revolution() const noexcept { return motor_counts * gear; }
  [[nodiscard]] double rad_per_count() const noexcept { return 2.0 * std::numbers::pi / counts_per_revolution(); }
  /// Torque quantum: resolution on the bus
  [[nodiscard]] double Nm_per_permille() const noexcept { return rated_torque_Nm * 1e-3; }
  [[nodiscard]] double max_torque_Nm() const noexcept { return Nm_per_permille() * max_torque_permille; }
};

/// The shipped Omni-class device: the record scenes/devices/omni.toml as compiled in, the default without --device. The
/// first call parses it.
[[nodiscard]] const Device& omni();

}  // namespace ligature::device
