#pragma once
// Attacks on a port's passivity: hand motions, control laws and frame losses, random or optimised.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "tests/support/random.hpp"
#include "tests/unit/control/passivity_port.hpp"

namespace ligature::control {

/// Parameters of one attack, which an optimiser may change. Time is divided into stretches of equal length ("knots" of
/// the path); each has an acceleration of the hand, and a part of the acceleration that follows the motors' force.
struct Attacker {
  static constexpr std::size_t kKnots = 40;
  std::array<Vec3, kKnots> push{};
  std::array<double, kKnots> along{};
  /// Coefficients of the control law: force = gain x position, with damping. A negative gain is a spring (force against
  /// the displacement).
  double gain_N_per_m = 400.0, damping_s = 0.01;
  int hold = 10;  ///< length of a stretch in periods
  Chain chain;

  /// Random parameters. With `loses`, up to 30 % of RPDOs, of samples or of both are lost.
  [[nodiscard]] static Attacker drawn(test::Random& random, double wildness, double count_m, bool loses) {
    Attacker a;
    for (std::size_t k = 0; k < kKnots; ++k) {
      const auto to = random.normals();
      a.push[k] = {to[0], to[1], to[2]};
      a.along[k] = random.happens(0.5) ? random.in(-2.0, 2.0) : 0.0;
    }
    const double sign = random.happens(0.5) ? 1.0 : -1.0;
    a.gain_N_per_m = sign * std::pow(10.0, random.in(1.5, 3.3));
    a.damping_s = random.in(0.0, 0.02);
    a.hold = static_cast<int>(random.any(1, 25));
    const double lost = random.in(0.0, 0.3), lost_samples = random.in(0.0, 0.3);
    const std::int64_t which = random.any(1, 3);
    a.chain.count_m = count_m, a.chain.wildness = wildness, a.chain.seed = random();
    a.chain.lost = loses && which != 1 ? lost : 0.0;
    a.chain.lost_samples = loses && which != 2 ? lost_samples : 0.0;
    a.chain.tells_torque = random.happens(0.5);
    return a;
  }

  /// A copy with random changes: of some stretches, and sometimes of the control law or the losses.
  [[nodiscard]] Attacker changed(test::Random& random, double size) const {
    Attacker a = *this;
    for (std::size_t k = 0; k < kKnots; ++k) {
      if (!random.happens(0.15)) continue;
      const auto by = random.normals();
      a.push[k] += size * Vec3(by[0], by[1], by[2]);
      a.along[k] += size * random.normal();
    }
    if (random.happens(0.2)) a.gain_N_per_m *= 1.0 + 0.5 * size * random.in(-1.0, 1.0);
    if (random.happens(0.2)) a.damping_s = std::max(0.0, a.damping_s + 0.005 * size * random.normal());
    if (random.happens(0.2)) a.hold = static_cast<int>(std::clamp<std::int64_t>(a.hold + random.any(-2, 2), 1, 25));
    if (random.happens(0.1)) a.chain.seed = random();
    for (double* lost : {&a.chain.lost, &a.chain.lost_samples})
      if (*lost > 0.0 && random.happens(0.1)) *lost = std::clamp(*lost + 0.1 * size * random.normal(), 1e-3, 0.3);
    return a;
  }

  [[nodiscard]] Port run(int ticks) const {
    Port port(true, 0.0, chain);
    const double most = chain.wildness * plain().hand_acceleration_m_per_s2;
    for (int i = 0; i < ticks; ++i) {
      const std::size_t k = static_cast<std::size_t>(i / hold) % kKnots;
      Vec3 pushed = push[k];
      if (!port.made.isZero()) pushed += along[k] * port.made.normalized();
      Vec3 acceleration = most * pushed / std::max(1.0, pushed.norm());
      if (port.v.norm() > 1.0) acceleration = -most * port.v.normalized();
      port.tick([this](const Vec3& p, const Vec3& v) { return saturated(gain_N_per_m * (p + damping_s * v)); },
                acceleration);
    }
    return port;
  }
};

/// Maximises `worse` with a (1+1) evolution strategy and the one-fifth success rule. @return the best attack found
template <class Worse>
[[nodiscard]] Attacker climb(Attacker best, int steps, int ticks, test::Random& random, Worse worse) {
  double most = worse(best.run(ticks)), size = 0.5;
  for (int i = 0; i < steps; ++i) {
    const Attacker next = best.changed(random, size);
    const double value = worse(next.run(ticks));
    size = std::clamp(size * (value > most ? 1.5 : 0.904), 0.02, 3.0);
    if (value >= most) best = next, most = value;
  }
  return best;
}

}  // namespace ligature::control
