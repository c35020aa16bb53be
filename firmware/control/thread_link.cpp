#include "firmware/control/thread_link.hpp"

#include <utility>

namespace ligature::control {

void ThreadLink::hand_over(std::int64_t tick, const std::array<physics::ToolInput, 2>& tools,
                           std::chrono::nanoseconds deadline) noexcept {
  exchange_.requests.back() = {tick, ++number_, tools, deadline, orders_.resets, plants(), plant_};
  exchange_.requests.publish();
}

Plant* ThreadLink::collect() noexcept {
  exchange_.results.refresh();
  return result().plants == plants() ? std::exchange(plant_, nullptr) : nullptr;
}

}  // namespace ligature::control
