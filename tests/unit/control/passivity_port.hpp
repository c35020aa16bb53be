#pragma once
// The passivity controller of one hand with a simulated plant: a mass moved by a hand and by motors, rounded positions
// and lost frames.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>

#include "firmware/control/passivity.hpp"
#include "firmware/control/window_velocity.hpp"
#include "tests/support/random.hpp"
#include "tests/unit/control/passivity_bounds.hpp"
#include "tests/unit/control/plain_device.hpp"

namespace ligature::control {

/// Transmission between controller and motors.
struct Chain {
  double count_m = 0.0;  // encoder resolution at the tip
  double lost = 0.0;     // share of RPDOs that are lost
  double lost_samples = 0.0;
  double guard_N = 1e9;  // the drive limits its force to this
  // true: the drive reports its torque. false: it reports whether it limits the torque, and the age of its last
  // command.
  bool tells_torque = true;
  std::uint64_t seed = 1;  // of the random losses
  double wildness = 1.0;   // the hand's acceleration as a share of the device file's limit
};

inline WindowVelocity velocity_of(const Chain& c) { return {kT_s, std::max(c.count_m, 1e-9)}; }

/// A mass moved by a hand and the motors; `wish` is the control law, the hand's acceleration is prescribed.
struct Port {
  explicit Port(bool active, double credit_J = 0.0, const Chain& c = {})
      : passivity(plain(), kT_s, active, credit_J), chain(c), random(c.seed), bounds(c.count_m, c.wildness) {}

  template <class Wish>
  void tick(Wish wish, const Vec3& acceleration) {
    see();
    // The drive applies the torques that have arrived.
    for (std::size_t j = 0; j < 3; ++j) {
      const bool arrives = random.share() >= chain.lost;  // each joint's drive has its own RPDO
      held[j] = arrives ? 0 : held[j] + 1;
      if (arrives) taken[static_cast<Eigen::Index>(j)] = on_its_way[static_cast<Eigen::Index>(j)];
    }
    const Vec3 made_before = made;
    made = taken.cwiseMax(-chain.guard_N).cwiseMin(chain.guard_N);
    if (n > forgiven) largest_made_step_N = std::max(largest_made_step_N, (made - made_before).norm());

    const Vec3 wished = wish(p, v), change = wished - before;
    const double step_N = plain().force_step_N;
    const Vec3 limited = before + change * std::min(1.0, step_N / std::max(change.norm(), step_N));
    const Vec3 paid = passivity.control(n, limited, v, before, made_of), f = made_of(paid);
    if (passivity.released()) ++released, forgiven = n + 20;  // the force drops to zero; a lost RPDO may delay that
    if (n > forgiven) largest_step_N = std::max(largest_step_N, (paid - before).norm());
    passivity.sent(n, f, f);
    before = paid;
    on_its_way = f;
    if (passivity.acts()) ++acted;
    const Vec3 moved = v * kT_s + 0.5 * acceleration * kT_s * kT_s;  // exact for a constant acceleration
    const bool missed = std::ranges::any_of(held, [](int ticks) { return ticks > 0; });
    bounds.period({f, made, made.dot(moved), last_seen, passivity.is_wary(n), moved, missed});
    work_J -= made.dot(moved);
    p += moved;
    v += acceleration * kT_s;
    ++n;
  }

  Passivity passivity;
  Chain chain;
  // The force that really acts when a force is sent, because the joint torques are rounded; by default without
  // rounding.
  std::function<Vec3(const Vec3&)> made_of = [](const Vec3& f) { return f; };
  test::Random random;
  PassivityBounds bounds;
  std::array<WindowVelocity, 3> rate{velocity_of(chain), velocity_of(chain), velocity_of(chain)};
  Vec3 p = Vec3::Zero(), v = Vec3::Zero(), before = Vec3::Zero();
  Vec3 on_its_way = Vec3::Zero(), taken = Vec3::Zero(), made = Vec3::Zero();
  double lowest_J = 0.0, work_J = 0.0, lowest_work_J = 0.0, largest_step_N = 0.0, largest_excess_J = -1e9;
  double largest_shortfall_J = -1e9, largest_made_step_N = 0.0;
  int acted = 0, released = 0;
  std::array<int, 3> held{};
  std::int64_t n = 0, last_seen = 0, forgiven = -1;

 private:
  /// SYNC: the encoders are sampled.
  void see() {
    const Vec3 seen = chain.count_m > 0.0 ? Vec3((p / chain.count_m).array().round() * chain.count_m) : p;
    PortSample sample{{seen.x(), seen.y(), seen.z()}, seen, chain.count_m, Vec3(1, 1, 1), {}, {}};
    if (chain.tells_torque) sample.acted.torque_Nm = made;
    sample.acted.limited.fill(made != taken);
    if (!chain.tells_torque) sample.acted.held = held;
    const bool is_seen = random.share() >= chain.lost_samples || n == 0;
    passivity.begin(n);
    if (is_seen) {
      for (std::size_t j = 0; j < 3; ++j) {
        rate[j].add(sample.q_rad[j], n - last_seen);
        sample.rate_rad_per_s[static_cast<Eigen::Index>(j)] = rate[j].velocity_per_s();
      }
      last_seen = n;
      passivity.observe(n, sample);
      largest_shortfall_J = std::max(largest_shortfall_J, work_J - passivity.energy_J());
      largest_excess_J = std::max(largest_excess_J, passivity.energy_J() - work_J);
      bounds.seen(n, passivity.energy_J(), work_J);
    }
    bounds.check(n, work_J);
    lowest_J = std::min(lowest_J, passivity.energy_J());
    lowest_work_J = std::min(lowest_work_J, work_J);
  }
};

inline Vec3 saturated(const Vec3& f) { return f.norm() > 3.3 ? Vec3(f * (3.3 / f.norm())) : f; }
inline Vec3 spring(const Vec3& p, const Vec3&) { return -400.0 * p; }

}  // namespace ligature::control
