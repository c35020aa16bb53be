#pragma once
// An operator that sees the thread and ties a named knot.

#include <random>
#include <string>
#include <variant>

#include "protocol/scene/scene.hpp"
#include "sim_device/operator/knots.hpp"

namespace ligature::sim {

/// Uniform random numbers, identical on every machine.
class Dice {
 public:
  explicit Dice(std::uint32_t seed) : random_(seed * 2654435761U + 12345U) {}
  double between(double low, double high) {
    return low + (high - low) * (static_cast<double>(random_()) / 4294967296.0);
  }
  Vec3 vector(double size) {
    const double x = between(-size, size), y = between(-size, size), z = between(-size, size);
    return {x, y, z};
  }

 private:
  std::mt19937 random_;
};

/// Ties one knot with two hands. The seed varies start positions, speed, start time, pauses and tremor (8-12 Hz). The
/// operator looks at the thread 100 times a second; between looks the hands continue. If a throw fails before it is
/// drawn tight, the hands let go, wait until the thread hangs still, and start again, at most three times.
class KnotTier {
 public:
  /// @return the operator, or why not: unknown knot, or a scene in which node 0 is not held.
  static std::variant<KnotTier, std::string> make(const scene::Scene& scene, const std::string& knot,
                                                  std::uint32_t seed);

  /// One tick: where both hands want to be now. @param sight what the operator sees; it may be older than this tick, by
  /// an unknown time.
  const std::array<HandWish, 2>& tick(const Sight& sight);

  [[nodiscard]] const std::array<HandWish, 2>& wish() const noexcept { return wish_; }
  /// Where both hands want to be, without tremor.
  [[nodiscard]] std::array<HandWish, 2> calm_wish() const noexcept {
    std::array<HandWish, 2> calm;
    for (std::size_t h = 0; h < 2; ++h) calm[h] = {hands_[h].p_W(), hands_[h].v_W(), hands_[h].grip};
    return calm;
  }
  [[nodiscard]] bool is_done() const noexcept { return next_ >= plan_.size(); }
  /// Name of the present move, for display.
  [[nodiscard]] std::string doing() const { return is_done() ? "done" : plan_[next_].name; }
  /// Moves that did not finish in time; empty if all did.
  [[nodiscard]] const std::vector<std::string>& missed() const noexcept { return missed_; }
  [[nodiscard]] const Knot& knot() const noexcept { return knot_; }

 private:
  KnotTier(const scene::Scene& scene, const Knot& knot, const Workplace& place, std::uint32_t seed);
  void look(const Sight& sight);
  void mind_the_pull(const Sight& sight);
  void lay_out(Moves moves);
  void begin_again();

  struct Tremor {
    Vec3 amplitude_m, rate_rad_per_s, phase;
  };

  Knot knot_;
  Workplace place_;
  Moves plan_;
  std::array<MovingHand, 2> hands_;
  std::array<Tremor, 2> tremor_;
  std::array<HandWish, 2> wish_{};
  ThreadView thread_;
  std::vector<std::string> missed_;
  std::size_t next_ = 0, throws_tied_ = 0;
  double tick_s_, start_s_ = 0.0, began_s_ = 0.0, t_s_ = 0.0;
  int until_look_ = 0, ticks_a_look_ = 10, begun_again_ = 0;
  Dice dice_;
};

}  // namespace ligature::sim
