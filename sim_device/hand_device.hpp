#pragma once
// One simulated hand: three drives on one cable, and the mechanics they turn. Knows no socket and no clock.

#include <array>
#include <cstdint>
#include <vector>

#include "sim_device/drive_node.hpp"
#include "sim_device/mechanics.hpp"
#include "sim_device/operator_path.hpp"
#include "sim_device/wire.hpp"

namespace ligature::sim {

/// A frame that the outside hears: from a drive, or from another client.
struct Delivery {
  can::Frame frame;
  int sender = 0;              ///< the client that must not hear itself; below kFirstClient it is a drive
  Time due{};                  ///< when its last bit has passed
  bool passed_faults = false;  ///< a FaultInjector has looked at it
};

struct BusStats {
  std::int64_t syncs = 0;
  std::int64_t missed_syncs = 0;  ///< gaps between SYNCs, in periods of the nominal 1 ms, less one
  Time first_sync{}, last_sync{};
  Time busy_at_first_sync{};  ///< bus load counts from here
  Time worst_rpdo{};          ///< latest end of an RPDO after its SYNC's end; the budget is one period
};

class HandDevice {
 public:
  static constexpr int kFirstClient = 3;
  static constexpr int kMaxClients = 12;
  static constexpr int kStranger = kFirstClient + kMaxClients;  ///< on the cable, but no client: a script puts it there
  static constexpr Time kPeriod = std::chrono::milliseconds(1);

  HandDevice(OperatorPath path, Time now, bool charge_bus_time = true);
  HandDevice(std::unique_ptr<Intention> intention, Time now, const Body& body = {}, bool charge_bus_time = true);

  /// A client puts a frame into its queue at `when`; per client, time must not run backwards.
  void submit(const can::Frame& frame, int client, Time when);
  /// Frames that wait in that queue.
  [[nodiscard]] std::size_t pending(int client) const noexcept { return wire_.pending(client); }
  void drop_client(int client) noexcept { wire_.drop(client); }
  /// Everything that happens until `now`: bus, drives, mechanics, in the order of their times.
  void advance(Time now);
  /// Frames that clients are to hear; the caller sends what is due and erases it.
  [[nodiscard]] std::vector<Delivery>& deliveries() noexcept { return deliveries_; }
  /// Next time at which advance() has something to do that cannot wait for the next frame. A burst of frames is one
  /// wake-up, at its end: a controller needs the whole set of TPDOs anyhow. `listeners` = number of clients.
  [[nodiscard]] Time wake_at(int listeners) const noexcept;

  void power_off() noexcept;
  /// One drive loses power and gets it back.
  void restart(std::size_t drive, Time now);
  void lead_astray(std::size_t drive, std::int16_t by_permille) noexcept { drives_[drive].go_astray(by_permille); }

  [[nodiscard]] std::array<std::int16_t, 3> torque_permille() const noexcept;
  [[nodiscard]] const Mechanics& mechanics() const noexcept { return mechanics_; }
  [[nodiscard]] const std::array<DriveNode, 3>& drives() const noexcept { return drives_; }
  [[nodiscard]] const WireStats& wire_stats() const noexcept { return wire_.stats(); }
  [[nodiscard]] const BusStats& bus_stats() const noexcept { return bus_; }
  /// Share of time the bus was busy between the first and the last SYNC; 0 before there are two.
  [[nodiscard]] double bus_load() const noexcept;

 private:
  void hear(const Transmission& heard);
  void poll(Time now);
  void move(Time now) noexcept;
  void send(std::size_t drive, Time now);
  void note(const can::Frame& frame, Time end) noexcept;

  Wire wire_;
  Mechanics mechanics_;
  std::array<DriveNode, 3> drives_;
  std::vector<Delivery> deliveries_;
  std::vector<can::Frame> outgoing_;  // of one drive's reaction; kept to spare allocations
  BusStats bus_;
  Time now_;
};

}  // namespace ligature::sim
