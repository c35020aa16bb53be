#pragma once
// Plant, fingers and operator as one thing that time moves: torques in, angles and buttons out.

#include <memory>

#include "sim_device/deadline.hpp"
#include "sim_device/drive_constants.hpp"
#include "sim_device/hand.hpp"
#include "sim_device/motor_heat.hpp"
#include "sim_device/operator_path.hpp"
#include "sim_device/plant.hpp"
#include "sim_device/stylus.hpp"

namespace ligature::sim {

inline constexpr Time kPlantStep = std::chrono::microseconds(100);  ///< longest; an interval is cut into equal ones
inline constexpr double kDeadManAfterScript_s = 1.0;
inline constexpr Time kPressesAgainAfter = std::chrono::milliseconds(200);

/// What the device is made of, and whose hand is on it.
struct Body {
  PlantParameters plant{};
  Hand hand{};
  Compliance compliance{};
  MotorRating motors{};
  DriveConstants drives{};

  /// A device as its record says, in a light hand.
  [[nodiscard]] static Body of(const device::Device& device);
};

class Mechanics {
 public:
  /// The device rests where the intention starts, with the hand on it. @pre that pose can be reached.
  Mechanics(std::unique_ptr<Intention> intention, Time now, const Body& body = {});
  Mechanics(OperatorPath path, Time now) : Mechanics(std::make_unique<OperatorPath>(std::move(path)), now) {}

  /// The operator begins; later calls change nothing.
  void start_script(Time now) noexcept;
  /// Whether all drives are on. The first time they are, the operator begins; whenever they go off, he lets go of the
  /// dead-man and presses it again when they have been on for kPressesAgainAfter.
  void feel_drives(bool on, Time now) noexcept;
  /// Moves everything to `now` under constant motor torques; an earlier time changes nothing. About 0.3 us a step.
  void advance(Time now, const Vec3& motor_Nm) noexcept;

  [[nodiscard]] std::int32_t counts(int joint) const noexcept { return body_.drives.counts_of(plant_.q_rad()[joint]); }
  [[nodiscard]] std::uint16_t buttons() const noexcept;
  [[nodiscard]] bool has_started() const noexcept { return started_at_ != kNever; }
  /// The script is over and the dead-man has been let go.
  [[nodiscard]] bool is_done() const noexcept {
    return has_started() && script_time_s() > intention_->end_s() + kDeadManAfterScript_s;
  }
  [[nodiscard]] const Body& body() const noexcept { return body_; }
  [[nodiscard]] const Plant& plant() const noexcept { return plant_; }
  [[nodiscard]] Intent intent() const noexcept { return intention_->at(script_time_s(), touch()); }
  /// Since the script's start; minus infinity before it.
  [[nodiscard]] double script_time_s() const noexcept;
  [[nodiscard]] double script_end_s() const noexcept { return intention_->end_s(); }
  /// The stylus where the fingers hold it; with links that bend, not where the joints say that it is.
  [[nodiscard]] Touch touch() const noexcept {
    if (!stylus_.is_rigid()) return {stylus_.position_D_m(), stylus_.velocity_D_m_per_s()};
    return {plant_.tip_D_m(), plant_.tip_velocity_D_m_per_s()};
  }
  /// What the motors have put into the linkage, J: the port's work, exact, whatever the encoders resolve.
  [[nodiscard]] double motor_work_J() const noexcept { return motor_work_J_; }
  /// Torques of the last step, N m: what was asked for, less what the drives held back.
  [[nodiscard]] const Vec3& made_Nm() const noexcept { return made_Nm_; }
  [[nodiscard]] const MotorHeat& motors() const noexcept { return motors_; }
  [[nodiscard]] const Fingers& fingers() const noexcept { return fingers_; }
  /// On the stylus by the fingers in the last step, N.
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
  Time pressed_from_ = kNever;  // the dead-man; never while the drives are off
};

}  // namespace ligature::sim
