#pragma once
// A CAN bus in memory, and a wait function that only advances the time.

#include <deque>
#include <functional>
#include <vector>

#include "firmware/platform/bus_wait.hpp"
#include "firmware/platform/can_bus.hpp"

namespace ligature::platform {

class FakeBus final : public CanBus {
 public:
  bool send(const can::Frame& frame) noexcept override {
    if (lost) return false;
    const bool refused = refuse_at == 0;
    if (refuse_at >= 0) --refuse_at;
    if (refused) return false;
    sent.push_back(frame);
    if (on_send) on_send(frame);
    return true;
  }
  Receive receive(can::Frame& frame) noexcept override {
    if (inbox.empty()) return lost ? Receive::kLost : Receive::kNothing;
    frame = inbox.front();
    inbox.pop_front();
    return Receive::kFrame;
  }
  [[nodiscard]] bool is_lost() const noexcept override { return lost; }
  [[nodiscard]] int descriptor() const noexcept override { return -1; }

  std::vector<can::Frame> sent;
  std::deque<can::Frame> inbox;
  std::function<void(const can::Frame&)> on_send;
  bool lost = false;
  long refuse_at = -1;  // this one of the next frames is not taken; negative: none
};

class FakeWait final : public BusWait {
 public:
  [[nodiscard]] Nanoseconds now() noexcept override { return time; }
  bool wait(Nanoseconds deadline) noexcept override {
    if (time >= deadline) return false;
    time += step;
    if (on_wait) on_wait();
    return true;
  }
  Nanoseconds time{0}, step{std::chrono::microseconds(100)};
  std::function<void()> on_wait;
};

}  // namespace ligature::platform
