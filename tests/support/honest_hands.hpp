#pragma once
// Encoder counts of three joints moved by a healthy operator: a mass pulled by a spring and a damper to a target.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "tests/support/random.hpp"

namespace ligature::test {

/// Motion in encoder counts and periods of 1 ms: one count is 0.05 mm at an Omni's tip, one count per period is 50
/// mm/s, and 0.02 counts/period^2 is 1 m/s2.
class HonestHand {
 public:
  enum class Kind : std::uint8_t { kTurning, kTrembling, kResting, kFast, kAbrupt };
  static constexpr std::array kKinds{Kind::kTurning, Kind::kTrembling, Kind::kResting, Kind::kFast, Kind::kAbrupt};
  [[nodiscard]] static const char* name(Kind kind) noexcept {
    return std::array{"turning", "trembling", "resting", "fast", "abrupt"}[static_cast<std::size_t>(kind)];
  }

  /// Hand stiffness is drawn from loose to clenched (80 .. 1600 N/m), and the target's acceleration from 5 to 100 m/s2.
  /// kAbrupt is different: a fixed stiffness and a target velocity that jumps.
  HonestHand(Kind kind, std::uint64_t seed) : kind_(kind), random_(seed) {
    const bool abrupt = kind == Kind::kAbrupt;
    const double tightness = random_.share();
    stiffness_ = abrupt ? 800.0 : 80.0 * std::pow(20.0, tightness);
    damping_ = abrupt ? 8.0 : 2.0 * std::pow(12.0, tightness);
    mass_kg_ = abrupt ? 0.045 : 0.065 * std::pow(3.0, tightness);
    stays_ = 40 + 7 * static_cast<double>(random_.any(0, 59));
    const double shakes = random_.share(), hertz = random_.in(4.0, 12.0);
    amplitude_ = kind == Kind::kTrembling ? 2.0 + 18.0 * shakes
                 : kind == Kind::kResting ? 4.0 * shakes
                 : abrupt                 ? (shakes < 1.0 / 3.0 ? 3.0 : 0.0)
                                          : 2.0 * shakes;
    pulsation_ = abrupt ? 0.06 : 2e-3 * std::acos(-1.0) * hertz;
    for (auto& phase : phase_) phase = random_.in(0.0, 6.28);
    speeding_ = abrupt ? 1e9 : 0.02 * random_.in(5.0, 100.0);
  }

  /// The next sample, one rounded count per joint.
  [[nodiscard]] std::array<double, 3> next() {
    if (t_ >= turns_at_) wish();
    std::array<double, 3> counts{};
    for (std::size_t j = 0; j < 3; ++j) {
      speed_[j] += std::clamp(wished_[j] - speed_[j], -speeding_, speeding_);
      at_[j] += speed_[j];
      for (int i = 0; i < 4; ++i) {
        const double push = stiffness_ * (at_[j] - x_[j]) + damping_ * (1e3 * speed_[j] - v_[j]);
        v_[j] += 0.25e-3 * push / mass_kg_;
        x_[j] += 0.25e-3 * v_[j];
      }
      const double tremor = amplitude_ > 0.0 ? amplitude_ * std::sin(pulsation_ * t_ + phase_[j]) : 0.0;
      counts[j] = std::round(x_[j] + tremor);
    }
    ++t_;
    return counts;
  }

 private:
  void wish() {
    turns_at_ += kind_ == Kind::kAbrupt ? stays_ : std::round(stays_ * random_.in(0.3, 2.0));
    const double top = kind_ == Kind::kFast        ? 10.0
                       : kind_ == Kind::kResting   ? 0.3
                       : kind_ == Kind::kTrembling ? 1.0
                                                   : 2.0;
    const double often = kind_ == Kind::kFast ? 0.8 : kind_ == Kind::kResting ? 0.2 : 0.5;
    for (auto& s : wished_) {
      const double speed = random_.in(-top, top);
      s = random_.happens(often) ? speed : 0.0;
    }
  }

  Kind kind_;
  Random random_;
  double stiffness_ = 0.0, damping_ = 0.0, mass_kg_ = 0.0, stays_ = 0.0, amplitude_ = 0.0, pulsation_ = 0.0;
  double speeding_ = 0.0, t_ = 0.0, turns_at_ = 0.0;
  // x_ counts, v_ counts/s; at_ (target) counts, speed_ and wished_ counts per period
  std::array<double, 3> phase_{}, x_{}, v_{}, at_{}, speed_{}, wished_{};
};

}  // namespace ligature::test
