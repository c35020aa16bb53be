#include "protocol/scene/monotone_cubic.hpp"

namespace ligature::scene {
namespace {

/// Velocity at a key: weighted harmonic mean, see pass_through().
/// @param d0,d1 mean velocities of the intervals before and after the key;  @param h0_s,h1_s their durations
double passing(double d0, double d1, double h0_s, double h1_s) noexcept {
  if (!(d0 * d1 > 0.0)) return 0.0;
  const double w0 = h0_s + 2.0 * h1_s, w1 = 2.0 * h0_s + h1_s;
  return (w0 + w1) / (w0 / d0 + w1 / d1);
}

}  // namespace

void pass_through(std::span<GripKey> keys) noexcept {
  for (GripKey& key : keys) key.v_W_m_per_s = key.turn_deg_per_s = {};
  for (std::size_t k = 1; k + 1 < keys.size(); ++k) {
    const GripKey &before = keys[k - 1], &after = keys[k + 1];
    GripKey& key = keys[k];
    const double h0_s = key.time_s - before.time_s, h1_s = after.time_s - key.time_s;
    const auto through = [&](double a, double b, double c) {
      return passing((b - a) / h0_s, (c - b) / h1_s, h0_s, h1_s);
    };
    for (std::size_t i = 0; i < 3; ++i) {
      key.v_W_m_per_s[i] = through(before.p_W_m[i], key.p_W_m[i], after.p_W_m[i]);
      key.turn_deg_per_s[i] = through(before.turn_deg[i], key.turn_deg[i], after.turn_deg[i]);
    }
  }
}

}  // namespace ligature::scene
