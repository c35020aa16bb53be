#pragma once
// Communicates with the device in a separate operating-system thread, so that a slow device does not delay the bus.

#include <atomic>
#include <chrono>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "bridge/device.hpp"

namespace ligature::bridge {

using Nanoseconds = std::chrono::nanoseconds;

/// The newest state of the device, and the end time of the exchange that brought it.
struct Heard {
  DeviceState state;
  Nanoseconds at{};
  std::int64_t number = 0;
};

/// Time from set_force() with a new force to the end of the exchange that gave the newest force to the device. This
/// wait is the delay that the bridge adds to a force. Exchanges that the device did not answer are not counted.
struct ForceWaits {
  std::int64_t forces = 0;  ///< new forces that reached the device
  Nanoseconds sum{}, worst{};
};

class Exchange {
 public:
  /// @param period shortest time between the starts of two exchanges. @param owner_within the force becomes zero when
  /// set_force() has not been called for this time.
  Exchange(std::unique_ptr<Device> device, Nanoseconds period, Nanoseconds owner_within);
  /// Sends zero force, then closes the device.
  ~Exchange();
  Exchange(const Exchange&) = delete;
  Exchange& operator=(const Exchange&) = delete;

  void set_force(const Vec& force_D_N, Nanoseconds now);
  [[nodiscard]] std::optional<Heard> newest() const;
  /// A file descriptor that becomes readable when a new state has come, until clear_event() is called.
  [[nodiscard]] int descriptor() const noexcept { return event_; }
  void clear_event() const noexcept;
  /// Why the device does not answer; empty: it does.
  [[nodiscard]] std::string problem() const;
  [[nodiscard]] std::int64_t exchanges() const noexcept { return exchanges_; }
  [[nodiscard]] Nanoseconds longest_exchange() const;
  [[nodiscard]] ForceWaits force_waits() const;

 private:
  void live(const std::stop_token& stop);
  struct Outgoing {
    Vec force_D_N{};
    std::optional<Nanoseconds> waits_since;
  };
  [[nodiscard]] Outgoing take_force(Nanoseconds now);
  void count(Nanoseconds begin, Nanoseconds end, std::optional<Nanoseconds> waited_since) noexcept;

  std::unique_ptr<Device> device_;
  Nanoseconds period_, owner_within_;
  int event_;
  mutable std::mutex mutex_;
  Vec force_{};
  Nanoseconds force_at_{}, longest_{};
  std::optional<Nanoseconds> waits_since_;  // set while no exchange has begun with the newest force
  ForceWaits waits_;
  std::optional<Heard> heard_;
  std::string problem_ = "not heard yet";
  std::atomic<std::int64_t> exchanges_{0};
  std::jthread thread_;  // last: uses all of the above
};

}  // namespace ligature::bridge
