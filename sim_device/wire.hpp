#pragma once
// The simulated CAN bus of one hand: one frame at a time, for its duration in bits; the lowest identifier has priority.

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "protocol/can/fd_time.hpp"
#include "protocol/can/frame.hpp"
#include "sim_device/deadline.hpp"

namespace ligature::sim {

/// A frame that won arbitration. It is received at `end`; from `start` on nothing can change it.
struct Transmission {
  can::Frame frame;
  int sender = 0;
  Time start{};
  Time end{};  ///< end of the last bit; the bus is free 3 bits later
};

struct WireStats {
  std::int64_t frames = 0;
  Time busy{};        ///< including interframe space
  Time worst_wait{};  ///< longest time from submit to start
};

/// Each sender has a queue, in order, as in a CAN controller; the first frames of the queues arbitrate. If charge_time
/// is false (because a real bus takes the time), frames pass in zero time, in the same order.
class Wire {
 public:
  explicit Wire(bool charge_time = true) : charge_time_(charge_time) {}

  /// Queues a frame at time `ready`, which must not decrease for a sender. Sender indices are 0 .. 15.
  void submit(const can::Frame& frame, int sender, Time ready);
  /// The next frame that wins the bus at or before `now`; call until it returns nothing. Frames submitted in between
  /// take part from their own ready time on.
  [[nodiscard]] std::optional<Transmission> advance(Time now);
  /// Time at which all queued frames will have been sent if none is added; kNever if the bus is idle.
  [[nodiscard]] Time quiet_at() const noexcept;
  /// Whether a frame with predicate(frame, sender) waits for the bus.
  template <class Predicate>
  [[nodiscard]] bool any_pending(Predicate predicate) const {
    for (std::size_t sender = 0; sender < queues_.size(); ++sender) {
      for (const Pending& p : queues_[sender]) {
        if (predicate(p.frame, static_cast<int>(sender))) return true;
      }
    }
    return false;
  }
  /// Number of frames of one sender that wait for the bus.
  [[nodiscard]] std::size_t pending(int sender) const noexcept {
    const auto index = static_cast<std::size_t>(sender);
    return index < queues_.size() ? queues_[index].size() : 0;
  }
  /// Discards the waiting frames of a sender that left.
  void drop(int sender) noexcept;

  [[nodiscard]] const WireStats& stats() const noexcept { return stats_; }

 private:
  struct Pending {
    can::Frame frame;
    Time ready;
    Time bits;  ///< duration of the frame on the bus
  };
  [[nodiscard]] Time earliest_ready() const noexcept;

  bool charge_time_;
  Time free_at_{};
  std::vector<std::deque<Pending>> queues_;
  WireStats stats_;
};

}  // namespace ligature::sim
