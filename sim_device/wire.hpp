#pragma once
// The cable of one hand: one frame at a time, each as long as its bits, the lowest identifier first.

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "protocol/can/bit_time.hpp"
#include "protocol/can/frame.hpp"
#include "sim_device/deadline.hpp"

namespace ligature::sim {

/// A frame that won the bus. Who hears it hears it at `end`; what lies behind it is fixed from `start` on, because
/// nothing can interrupt a frame.
struct Transmission {
  can::Frame frame;
  int sender = 0;
  Time start{};
  Time end{};  ///< last bit of the frame; the bus is free again 3 bits later
};

struct WireStats {
  std::int64_t frames = 0;
  Time busy{};        ///< interframe space included
  Time worst_wait{};  ///< from submit to start
};

/// Each sender has a queue of its own, in order, as a CAN controller has; the heads of the queues arbitrate.
/// With charge_time off (a real bus below charges its own) frames pass in no time, in the same order.
class Wire {
 public:
  explicit Wire(bool charge_time = true) : charge_time_(charge_time) {}

  /// Sender indices are small and dense (0 .. 15). `ready` must not decrease for one sender.
  void submit(const can::Frame& frame, int sender, Time ready);
  /// The next frame that wins the bus at or before `now`; call until it gives nothing. Frames submitted in between
  /// take part as of their own ready time.
  [[nodiscard]] std::optional<Transmission> advance(Time now);
  /// When the frames known so far will all have been heard if nobody adds one; kNever if the wire is idle.
  [[nodiscard]] Time quiet_at() const noexcept;
  /// True when a frame for which predicate(frame, sender) holds waits for the bus.
  template <class Predicate>
  [[nodiscard]] bool any_pending(Predicate predicate) const {
    for (std::size_t sender = 0; sender < queues_.size(); ++sender) {
      for (const Pending& p : queues_[sender]) {
        if (predicate(p.frame, static_cast<int>(sender))) return true;
      }
    }
    return false;
  }
  /// Of one sender, waiting for the bus.
  [[nodiscard]] std::size_t pending(int sender) const noexcept {
    const auto index = static_cast<std::size_t>(sender);
    return index < queues_.size() ? queues_[index].size() : 0;
  }
  /// Forgets what a sender that left has not yet sent.
  void drop(int sender) noexcept;

  [[nodiscard]] const WireStats& stats() const noexcept { return stats_; }

 private:
  struct Pending {
    can::Frame frame;
    Time ready;
    Time bits;  ///< time the frame holds the bus
  };
  [[nodiscard]] Time earliest_ready() const noexcept;

  bool charge_time_;
  Time free_at_{};
  std::vector<std::deque<Pending>> queues_;
  WireStats stats_;
};

}  // namespace ligature::sim
