#pragma once
// Wait-free exchange between the control loop and the physics: tools in one direction, grasps and diagnostics in the
// other.

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

/// The physics publishes the thread's shape once every so many ticks.
inline constexpr std::int64_t kTicksPerShape = 8;

/// Request of the loop to the physics, once per period.
struct ThreadRequest {
  std::int64_t tick = -1;   ///< period in which it was made
  std::int64_t number = 0;  ///< of the request, counted from 1; lost periods make no request
  std::array<physics::ToolInput, 2> tools;
  std::chrono::nanoseconds deadline{};  ///< on the loop's clock
  std::int64_t resets = 0;              ///< resets requested so far; if larger than before, the thread restarts
  std::int64_t plants = 0;              ///< changes (plants) handed over so far, including this one
  Plant* plant = nullptr;               ///< owned by the loop's side; lent until a result reports it as processed
};

/// A request that the physics has answered.
struct ThreadStep {
  std::int64_t tick = -1;
  int cut_at = -1;  ///< number of the clock query that ended the physics tick early; -1: it ended regularly
};

/// Result of the newest answered request.
struct ThreadResult {
  std::int64_t tick = -1;   ///< period in which that request was made
  std::int64_t number = 0;  ///< number of that request
  std::array<physics::HandContact, 2> hand;
  physics::Diagnostics health;
  std::chrono::nanoseconds began{}, done{};               ///< on the loop's clock
  std::chrono::nanoseconds work{};                        ///< CPU time
  std::int64_t plants = 0;                                ///< changes (plants) processed so far
  std::int64_t steps = 0;                                 ///< requests answered so far
  std::array<ThreadStep, rt::kThreadSteps> last_steps{};  ///< newest first

  /// Appends an answered request.
  void add_step(ThreadStep step) noexcept {
    std::shift_right(last_steps.begin(), last_steps.end(), 1);
    last_steps.front() = step;
    ++steps;
  }
};

/// How many resets, scene changes and parameter changes the loop has ordered from the physics so far.
struct ThreadOrders {
  std::int64_t resets = 0, scenes = 0, parameters = 0;
};

/// A triple buffer for each direction (latest_value.hpp): no side ever waits for the other or reads a half-written
/// value. The physics sees only the newest request; requests that arrive during a long physics tick are skipped. So
/// resets are sent as a counter, and a new simulation (plant) is sent again in each request until a result answers it.
struct ThreadExchange {
  rt::LatestValue<ThreadRequest> requests;  ///< loop -> physics
  rt::LatestValue<ThreadResult> results;    ///< physics -> loop
};

/// The loop's side of the exchange.
class ThreadLink {
 public:
  explicit ThreadLink(ThreadExchange& exchange) noexcept : exchange_(exchange) {}

  /// The next request restarts the thread.
  void reset() noexcept { ++orders_.resets; }
  /// The next request replaces the simulation. @pre !is_changing()
  void change(Plant* plant) noexcept {
    plant_ = plant;
    ++(plant->keeps_motion ? orders_.parameters : orders_.scenes);
  }
  [[nodiscard]] bool is_changing() const noexcept { return plant_ != nullptr; }
  /// A new scene is being installed: the hands are still those of the old one.
  [[nodiscard]] bool changes_scene() const noexcept { return plant_ != nullptr && !plant_->keeps_motion; }

  void hand_over(std::int64_t tick, const std::array<physics::ToolInput, 2>& tools,
                 std::chrono::nanoseconds deadline) noexcept;

  /// Takes the newest result. @return the new simulation (plant.hpp) that the physics has now accepted or refused;
  /// nullptr if there is none.
  [[nodiscard]] Plant* collect() noexcept;
  [[nodiscard]] const ThreadResult& result() const noexcept { return exchange_.results.front(); }
  /// Numbers of resets and changes ordered up to the newest request.
  [[nodiscard]] const ThreadOrders& orders() const noexcept { return orders_; }
  /// How many requests are newer than the one that the newest result answers; 0: the physics is in time.
  [[nodiscard]] std::int64_t late_ticks() const noexcept { return number_ - result().number; }

 private:
  [[nodiscard]] std::int64_t plants() const noexcept { return orders_.scenes + orders_.parameters; }

  ThreadExchange& exchange_;
  std::int64_t number_ = 0;
  ThreadOrders orders_;
  Plant* plant_ = nullptr;
};

}  // namespace ligature::control
