#pragma once
// The virtual rig with two steered hands, run a number of periods at a time. For tests that decide, from what they see,
// what the hands do next.

#include <array>
#include <cstdint>
#include <exception>
#include <limits>
#include <optional>
#include <semaphore>
#include <span>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "host/lab/rig/virtual_rig.hpp"
#include "protocol/scene/fault_script.hpp"
#include "sim_device/page/steered_hand.hpp"

namespace ligature::lab {

/// What a steered hand is to do; the same content as the message hand_wish_t, which steers a device that is a process
/// of its own.
struct SteeredWish {
  sim::Vec3 p_W_m = sim::Vec3::Zero();
  bool dead_man = false, grip = false;
};

/// Between two calls of advance() nothing moves. The rig runs in a thread of its own, which alternates with the caller
/// and never runs beside it: equal calls give equal results, bit by bit.
class SteppedRig {
 public:
  /// @throws std::runtime_error with one line when the physics refuses the scene, or when two faults are for one hand.
  SteppedRig(const scene::Scene& scene, std::span<const scene::FaultScript> faults);
  ~SteppedRig();
  SteppedRig(const SteppedRig&) = delete;
  SteppedRig& operator=(const SteppedRig&) = delete;

  /// Runs the start-up, if it has not been run, and `periods` periods of 1 ms. @throws std::runtime_error with the
  /// reason when the rig does not start.
  void advance(std::int64_t periods);

  /// Takes effect in the next period.
  void command(rt::CommandKind kind) { rig_.outlets->commands.push({++commands_, kind}); }
  /// Holds until the next call for this hand; sent to the hand every 20 ms, as over LCM.
  void wish(std::size_t hand, const SteeredWish& wish) { wishes_.at(hand) = wish; }

  /// One record for each finished period.
  [[nodiscard]] const std::vector<rt::TickRecord>& records() const { return rig_.records; }
  [[nodiscard]] std::span<const physics::Vec3> nodes_W() const { return rig_.thread.nodes_W(); }
  /// True force at a hand's tip, N, one entry for each period (true_tip.hpp).
  [[nodiscard]] const std::vector<TrueTip>& truth(std::size_t hand) const { return rig_.truth.at(hand).tips(); }

 private:
  static constexpr std::int64_t kAll = std::numeric_limits<std::int64_t>::max(), kWishEvery = 20;

  void live();
  void after_a_period();
  void steer();

  std::array<sim::SteeredHand*, 2> hands_{};  // owned by the rig's devices
  VirtualRig rig_;
  std::array<SteeredWish, 2> wishes_;
  std::int64_t commands_ = 0, left_ = 0, steered_ = 0;
  bool ends_ = false;
  std::optional<std::string> why_ended_;
  std::binary_semaphore goes_{0}, rests_{0};
  std::jthread thread_;  // last member: begins when the others exist
};

/// Whether a device of the shipped class reaches this point of the scene's world; without this check, a hand that is
/// sent out of reach would stop on the way. @return empty, or "found .., allowed .."
[[nodiscard]] std::string out_of_reach(const scene::Scene& scene, const sim::Vec3& p_W_m);

}  // namespace ligature::lab
