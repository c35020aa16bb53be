#pragma once
// Between the loop and the thread's physics: tools one way, the grasp the other, and neither ever waits.

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <limits>

#include "firmware/control/plant.hpp"
#include "firmware/physics/simulation.hpp"
#include "firmware/rt/latest_value.hpp"
#include "firmware/rt/tick_record.hpp"

namespace ligature::control {

/// Ticks of the thread between two shapes that it tells.
inline constexpr std::int64_t kTicksPerShape = 8;

/// What the loop asks for, once a period.
struct ThreadRequest {
  std::int64_t tick = -1;   ///< the period
  std::int64_t number = 0;  ///< of the request, from 1 on: periods in which the loop did nothing have none
  std::array<physics::ToolInput, 2> tools;
  std::chrono::nanoseconds deadline{};  ///< on the loop's clock
  std::int64_t resets = 0;              ///< asked for so far; the thread starts anew when this has grown
  std::int64_t plants = 0;              ///< handed over so far, this one included;
  Plant* plant = nullptr;               ///< lent until a result says that it is done with
};

/// A request that was answered.
struct ThreadStep {
  std::int64_t tick = -1;
  int cut_at = -1;  ///< physics::Diagnostics
};

/// What the physics made of it.
struct ThreadResult {
  std::int64_t tick = -1;   ///< of the request that was answered,
  std::int64_t number = 0;  ///< and its number
  std::array<physics::HandContact, 2> hand;
  physics::Diagnostics health;
  std::chrono::nanoseconds began{}, done{};               ///< on the loop's clock
  std::chrono::nanoseconds work{};                        ///< CPU time
  std::int64_t plants = 0;                                ///< done with so far
  std::int64_t steps = 0;                                 ///< requests answered so far,
  std::array<ThreadStep, rt::kThreadSteps> last_steps{};  ///< the newest of them first

  /// One more.
  void add_step(ThreadStep step) noexcept {
    std::shift_right(last_steps.begin(), last_steps.end(), 1);
    last_steps.front() = step;
    ++steps;
  }
};

/// What was asked of the thread so far, besides ticks.
struct ThreadOrders {
  std::int64_t resets = 0, scenes = 0, parameters = 0;
};

/// Both directions. Either side owns one slot of each triple buffer whole, so neither can be held up or see half of
/// something; the exchange that hands a slot over releases what was written and acquires what the other side wrote
/// (latest_value.hpp). The newest request counts: what came in while a tick took too long is not made up for. What must
/// not be lost with a request that was passed over is counted (resets) or told again until it is answered (a plant).
struct ThreadExchange {
  rt::LatestValue<ThreadRequest> requests;  ///< loop -> physics
  rt::LatestValue<ThreadResult> results;    ///< physics -> loop
};

/// The loop's end of it.
class ThreadLink {
 public:
  explicit ThreadLink(ThreadExchange& exchange) noexcept : exchange_(exchange) {}

  /// With the next tools: the thread starts anew.
  void reset() noexcept { ++orders_.resets; }
  /// With the next tools: another thread. @pre !is_changing()
  void change(Plant* plant) noexcept {
    plant_ = plant;
    ++(plant->keeps_motion ? orders_.parameters : orders_.scenes);
  }
  [[nodiscard]] bool is_changing() const noexcept { return plant_ != nullptr; }
  /// Another scene is under way: the hands are still those of the old one.
  [[nodiscard]] bool changes_scene() const noexcept { return plant_ != nullptr && !plant_->keeps_motion; }

  void hand_over(std::int64_t tick, const std::array<physics::ToolInput, 2>& tools,
                 std::chrono::nanoseconds deadline) noexcept;

  /// Moves to the newest result. @return a plant that is done with, taken or not; else nullptr.
  [[nodiscard]] Plant* collect() noexcept;
  [[nodiscard]] const ThreadResult& result() const noexcept { return exchange_.results.front(); }
  /// With the newest tools.
  [[nodiscard]] const ThreadOrders& orders() const noexcept { return orders_; }
  /// Tools handed over that the newest result has not seen; 0: the thread is in time.
  [[nodiscard]] std::int64_t late_ticks() const noexcept { return number_ - result().number; }

 private:
  [[nodiscard]] std::int64_t plants() const noexcept { return orders_.scenes + orders_.parameters; }

  ThreadExchange& exchange_;
  std::int64_t number_ = 0;
  ThreadOrders orders_;
  Plant* plant_ = nullptr;
};

}  // namespace ligature::control
