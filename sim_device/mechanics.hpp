#pragma once
// Mechanics of device, fingers and operator together: motor torques in, joint angles and buttons out.

#include <memory>

#include "sim_device/deadline.hpp"
#include "sim_device/drive_constants.hpp"
#include "sim_device/hand.hpp"
#include "sim_device/motor_heat.hpp"
#include "sim_device/operator_path.hpp"
#include "sim_device/plant.hpp"
#include "sim_device/stylus.hpp"

namespace ligature::sim {

/// Longest time step; intervals are divided into equal steps
inline constexpr Time kPlantStep = std::chrono::microseconds(100);
inline constexpr double kDeadManAfterScript_s = 1.0;
inline constexpr Time kPressesAgainAfter = std::chrono::milliseconds(200);

/// Parameters of the device and of the hand that holds it.
struct Body {
  PlantParameters plant{};
  Hand hand{};
  Compliance compliance{};
  MotorRating motors{};
  DriveConstants drives{};

  /// The device of a record, held by a light hand.
  [[nodiscard]] static Body of(const device::Device& device);
};

class Mechanics {
 public:
  /// The device rests at the intention's start, with the hand on it. @pre that position can be reached.
  Mechanics(std::unique_ptr<Intention> intention, Time now, const Body& body = {});
  Mechanics(OperatorPath path, Time now) : Mechanics(std::make_unique<OperatorPath>(std::move(path)), now) {}

  /// Starts the operator; later calls have no effect.
  void start_script(Time now) noexcept;
  /// Reports whether all drives are on. The operator starts when they are on for the first time. Whenever a drive goes
  /// off, the operator releases the dead-man, and presses it again kPressesAgainAfter after all drives are back on.
  void feel_drives(bool on, Time now) noexcept;
  /// Advances everything to `now` with constant motor torques; an earlier time has no effect. About 0.3 us per step.
  void advance(Time now, const Vec3& motor_Nm) noexcept;

  [[nodiscard]] std::int32_t counts(int joint) const noexcept { return body_.drives.counts_of(plant_.q_rad()[joint]); }
  [[nodiscard]] std::uint16_t buttons() const noexcept;
  [[nodiscard]] bool has_started() const noexcept { return started_at_ != kNever; }
  /// Whether the script is over and the dead-man released.
  [[nodiscard]] bool is_done() const noexcept {
    return has_started() && script_time_s() > intention_->end_s() + kDeadManAfterScript_s;
  }
  [[nodiscard]] const Body& body() const noexcept { return body_; }
  [[nodiscard]] const Plant& plant() const noexcept { return plant_; }
  [[nodiscard]] Intent intent() const noexcept { return intention_->at(script_time_s(), touch()); }
  /// Time at which the script started; kNever before it.
  [[nodiscard]] Time started_at() const noexcept { return started_at_; }
  /// Time since the script's start; minus infinity before it.
  [[nodiscard]] double script_time_s() const noexcept;
  [[nodiscard]] double script_end_s() const noexcept { return intention_->end_s(); }
  /// The stylus where the fingers hold it; with elastic links this differs from the tip computed from the joints.
  [[nodiscard]] Touch touch() const noexcept {
    if (!stylus_.is_rigid()) return {stylus_.position_D_m(), stylus_.velocity_D_m_per_s()};
    return {plant_.tip_D_m(), plant_.tip_velocity_D_m_per_s()};
  }
  /// Work that the motors have done on the linkage, J; exact, because it is not computed from quantised encoder
  /// positions.
  [[nodiscard]] double motor_work_J() const noexcept { return motor_work_J_; }
  /// Motor torques of the last step, N m: as commanded, but limited where a drive protects its winding.
  [[nodiscard]] const Vec3& made_Nm() const noexcept { return made_Nm_; }
  [[nodiscard]] const MotorHeat& motors() const noexcept { return motors_; }
  [[nodiscard]] const Fingers& fingers() const noexcept { return fingers_; }
  /// Force of the fingers on the stylus in the last step, N.
  [[nodiscard]] const Vec3& hand_force_D_N() const noexcept { return hand_force_D_N_; }

 private:
  std::unique_ptr<Intention> intention_;
  Body body_;
  Plant plant_;
  Stylus stylus_;
  Fingers fingers_;
  MotorHeat motors_;
  double motor_work_J_ = 0.0;
  Vec3 hand_force_D_N_ = Vec3::Zero(), made_Nm_ = Vec3::Zero();
  Time now_;
  Time started_at_ = kNever;
  Time pressed_from_ = kNever;  // from when on the dead-man is pressed; kNever while the drives are off
};

}  // namespace ligature::sim
