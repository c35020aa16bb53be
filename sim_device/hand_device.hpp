#pragma once
// One simulated hand: three drives on one bus, and the mechanics that they move. Uses no sockets and no clock.

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "sim_device/drive_node.hpp"
#include "sim_device/mechanics.hpp"
#include "sim_device/operator_path.hpp"
#include "sim_device/wire.hpp"

namespace ligature::sim {

/// A frame to be sent to the clients: from a drive, or from another client.
struct Delivery {
  can::Frame frame;
  int sender = 0;              ///< the sender, which does not get its own frame; a drive if below kFirstClient
  Time due{};                  ///< end of the frame's last bit
  bool passed_faults = false;  ///< a FaultInjector has processed it
};

struct BusStats {
  std::int64_t syncs = 0;
  std::int64_t missed_syncs = 0;  ///< periods of 1 ms without SYNC between two SYNCs
  Time first_sync{}, last_sync{};
  Time busy_at_first_sync{};  ///< bus time used before the first SYNC, excluded from the bus load
  Time worst_rpdo{};          ///< latest end of an RPDO after the end of its SYNC; must stay below one period
};

using BusNodes = std::array<std::unique_ptr<BusNode>, 3>;

class HandDevice {
 public:
  static constexpr int kFirstClient = 3;
  static constexpr int kMaxClients = 12;
  static constexpr int kStranger = kFirstClient + kMaxClients;  ///< sender index of frames injected by a fault script
  static constexpr Time kPeriod = std::chrono::milliseconds(1);

  HandDevice(OperatorPath path, Time now, bool charge_bus_time = true);
  HandDevice(std::unique_ptr<Intention> intention, Time now, const Body& body = {}, bool charge_bus_time = true);
  /// @param drives  waist, shoulder, elbow, which also has the stylus' buttons
  HandDevice(std::unique_ptr<Intention> intention, Time now, const Body& body, bool charge_bus_time, BusNodes drives);

  /// A client queues a frame at time `when`; per client, time must not decrease.
  void submit(const can::Frame& frame, int client, Time when);
  /// Number of a client's frames that wait for the bus.
  [[nodiscard]] std::size_t pending(int client) const noexcept { return wire_.pending(client); }
  void drop_client(int client) noexcept { wire_.drop(client); }
  /// Simulates bus, drives and mechanics until `now`, in order of time.
  void advance(Time now);
  /// Frames for the clients; the caller sends those that are due and erases them.
  [[nodiscard]] std::vector<Delivery>& deliveries() noexcept { return deliveries_; }
  /// Next time at which advance() must be called even if no frame arrives. A burst of frames causes a single wake-up,
  /// at the end of the burst, because a controller needs all TPDOs anyway. `listeners`: number of clients.
  [[nodiscard]] Time wake_at(int listeners) const noexcept;

  void power_off() noexcept;
  /// Power-cycles one drive.
  void restart(std::size_t drive, Time now);
  void lead_astray(std::size_t drive, std::int16_t by_permille) { cia402(drive).go_astray(by_permille); }

  [[nodiscard]] bool begins_period(const can::Frame& frame) const noexcept {
    return drives_[0]->meaning_of(frame) == Meaning::kPeriod;
  }
  [[nodiscard]] std::array<std::int16_t, 3> torque_permille() const noexcept;
  [[nodiscard]] const Mechanics& mechanics() const noexcept { return mechanics_; }
  [[nodiscard]] const BusNodes& drives() const noexcept { return drives_; }
  /// @throw std::bad_cast unless the drives are of CiA 402
  [[nodiscard]] DriveNode& cia402(std::size_t drive) { return dynamic_cast<DriveNode&>(*drives_[drive]); }
  [[nodiscard]] const WireStats& wire_stats() const noexcept { return wire_.stats(); }
  [[nodiscard]] const BusStats& bus_stats() const noexcept { return bus_; }
  /// Fraction of the time between the first and the last SYNC in which the bus was busy; 0 with fewer than two SYNCs.
  [[nodiscard]] double bus_load() const noexcept;

 private:
  void hear(const Transmission& heard);
  [[nodiscard]] Sensed sensed(std::size_t drive) const noexcept;
  void poll(Time now);
  void move(Time now) noexcept;
  void send(std::size_t drive, Time now);
  void note(Meaning meaning, Time end) noexcept;
  void feel_drives(Meaning meaning, Time end) noexcept;

  Wire wire_;
  Mechanics mechanics_;
  BusNodes drives_;
  std::vector<Delivery> deliveries_;
  std::vector<can::Frame> outgoing_;  // frames that a drive's reaction produces; a member to avoid allocations
  BusStats bus_;
  Time now_;
  int regular_periods_ = 0;  // with a torque each, all drives on
  bool had_torque_ = false;  // since the last period began
};

}  // namespace ligature::sim
