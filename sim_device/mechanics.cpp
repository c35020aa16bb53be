#include "sim_device/mechanics.hpp"

#include <limits>
#include <utility>

namespace ligature::sim {
namespace {

constexpr double kBeforeScript_s = -std::numeric_limits<double>::infinity();

double seconds(Time t) noexcept { return std::chrono::duration<double>(t).count(); }

}  // namespace

Mechanics::Mechanics(std::unique_ptr<Intention> intention, Time now, const Body& body)
    : intention_(std::move(intention)),
      body_(body),
      plant_(body.plant.linkage.joints(intention_->start_D_m()).value(), body.plant),
      stylus_(body.compliance, plant_.tip_D_m()),
      fingers_(body.hand, plant_.tip_D_m()),
      motors_(body.motors),
      now_(now) {}

Body Body::of(const device::Device& device) {
  Body body;
  body.plant = PlantParameters::of(device);
  const Vec3 lever_m =
      body.plant.linkage.jacobian_D(body.plant.linkage.joints(body.plant.linkage.home_D_m()).value()).colwise().norm();
  // The drives protect their windings at 1.2 times the record's continuous torque, so that the controller's thermal
  // limit acts first.
  body.motors = {1.2 * device.continuous_force_N * lever_m, device.thermal_time_s};
  body.drives.counts_per_revolution = static_cast<std::uint32_t>(std::lround(device.counts_per_revolution()));
  body.drives.rated_torque_mNm = static_cast<std::uint32_t>(std::lround(device.rated_torque_Nm * 1e3));
  body.drives.max_torque_permille = device.max_torque_permille;
  return body;
}

void Mechanics::start_script(Time now) noexcept {
  if (!has_started()) started_at_ = pressed_from_ = now;
}

void Mechanics::feel_drives(bool on, Time now) noexcept {
  if (on && has_started() && pressed_from_ == kNever) pressed_from_ = now + kPressesAgainAfter;
  if (on) start_script(now);
  if (!on) pressed_from_ = kNever;
}

double Mechanics::script_time_s() const noexcept {
  return has_started() ? seconds(now_ - started_at_) : kBeforeScript_s;
}

void Mechanics::advance(Time now, const Vec3& motor_Nm) noexcept {
  if (now <= now_) return;
  const auto steps = (now - now_ + kPlantStep - Time(1)) / kPlantStep;
  const Time from = now_, span = now - now_;
  const double dt_s = seconds(span) / static_cast<double>(steps);
  for (std::int64_t i = 1; i <= steps; ++i) {
    now_ = from + span * i / steps;
    const Touch tip = touch();
    const Intent wish = intention_->at(script_time_s(), tip);
    hand_force_D_N_ = fingers_.step(wish.p_DH, wish.v_DH, tip.p_DT, tip.v_DT, dt_s);
    const Vec3 on_linkage = stylus_.step(hand_force_D_N_, plant_.tip_D_m(), plant_.tip_velocity_D_m_per_s(), dt_s);
    const Vec3 from_rad = plant_.q_rad();
    made_Nm_ = motors_.pass(motor_Nm, dt_s);
    plant_.step(made_Nm_, on_linkage, dt_s);
    motor_work_J_ += made_Nm_.dot(plant_.q_rad() - from_rad);
  }
}

std::uint16_t Mechanics::buttons() const noexcept {
  if (!has_started()) return 0;
  const double t_s = script_time_s();
  const Intent wish = intention_->at(t_s, touch());
  unsigned pressed = wish.grip ? can::profile::kButtonGrip : 0U;
  const bool holds_on = wish.dead_man && now_ >= pressed_from_ && t_s <= intention_->end_s() + kDeadManAfterScript_s;
  if (holds_on) pressed |= can::profile::kButtonDeadMan;
  return static_cast<std::uint16_t>(pressed);
}

}  // namespace ligature::sim
