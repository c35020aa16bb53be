#pragma once
// Hands that disturb: with tremor, or pushing against the device's stability.

#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <numbers>
#include <random>

#include "sim_device/intention.hpp"

namespace ligature::sim {

/// Physiological tremor added to another intention: p_DH + A sin(2π f t + φ) on each axis; random phases, f differs by
/// 10 % between axes.
class Trembling final : public Intention {
 public:
  Trembling(std::unique_ptr<Intention> calm, double amplitude_m, double frequency_Hz, std::uint32_t seed = 1)
      : calm_(std::move(calm)), amplitude_m_(amplitude_m) {
    std::mt19937 random(seed);
    for (std::size_t i = 0; i < 3; ++i) {
      phase_rad_[i] = 2.0 * std::numbers::pi * static_cast<double>(random()) * 0x1p-32;
      pulsation_rad_per_s_[i] = 2.0 * std::numbers::pi * frequency_Hz * (0.9 + 0.1 * static_cast<double>(i));
    }
  }
  [[nodiscard]] Intent at(double t_s, const Touch& touch) const noexcept override {
    Intent now = calm_->at(t_s, touch);
    if (!(t_s > 0.0)) return now;
    for (Eigen::Index i = 0; i < 3; ++i) {
      const double w = pulsation_rad_per_s_[static_cast<std::size_t>(i)];
      const double angle = w * t_s + phase_rad_[static_cast<std::size_t>(i)];
      now.p_DH[i] += amplitude_m_ * std::sin(angle);
      now.v_DH[i] += amplitude_m_ * w * std::cos(angle);
    }
    return now;
  }
  [[nodiscard]] double end_s() const noexcept override { return calm_->end_s(); }
  [[nodiscard]] Vec3 start_D_m() const noexcept override { return calm_->start_D_m(); }

 private:
  std::unique_ptr<Intention> calm_;
  double amplitude_m_;
  std::array<double, 3> phase_rad_{}, pulsation_rad_per_s_{};
};

/// Pushes in the direction of the stylus' motion: the intended point becomes p_DH + reach tanh(lead v / reach), v the
/// stylus' velocity. This acts like a negative damping constant of (hand stiffness) x lead, the worst case for
/// stability with a hand of this reach.
class Adversarial final : public Intention {
 public:
  Adversarial(std::unique_ptr<Intention> calm, double lead_s, double reach_m)
      : calm_(std::move(calm)), lead_s_(lead_s), reach_m_(reach_m) {}
  [[nodiscard]] Intent at(double t_s, const Touch& touch) const noexcept override {
    Intent now = calm_->at(t_s, touch);
    const double speed = touch.v_DT.norm();
    if (!(t_s > 0.0) || speed < 1e-9) return now;
    now.p_DH += reach_m_ * std::tanh(lead_s_ * speed / reach_m_) / speed * touch.v_DT;
    now.v_DH = touch.v_DT;  // the hand's damper then does not damp the motion
    return now;
  }
  [[nodiscard]] double end_s() const noexcept override { return calm_->end_s(); }
  [[nodiscard]] Vec3 start_D_m() const noexcept override { return calm_->start_D_m(); }

 private:
  std::unique_ptr<Intention> calm_;
  double lead_s_, reach_m_;
};

}  // namespace ligature::sim
