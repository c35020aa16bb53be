#pragma once
// Three drives on a bus that stand for a Cartesian device: its position becomes joint angles, their torques become its
// force. Uses no sockets and no clock.

#include <array>
#include <optional>
#include <vector>

#include "bridge/device.hpp"
#include "sim_device/drive_node.hpp"
#include "sim_device/hand_device.hpp"
#include "sim_device/kinematics.hpp"
#include "sim_device/wire.hpp"

namespace ligature::bridge {

using sim::Time;

/// Ages of the device's state at each SYNC: the delay that the bridge adds to a position sample.
struct SampleAges {
  std::int64_t syncs = 0;
  std::int64_t stale = 0;   ///< not answered, because the state was too old or the device was silent
  std::int64_t silent = 0;  ///< of these: the device was silent
  Time sum{}, worst{};
};

class Drives {
 public:
  /// @param silence after which the device counts as lost. @param charge_bus_time as in sim::Wire.
  Drives(const device::Device& record, Time now, Time silence, bool charge_bus_time = true);

  void submit(const can::Frame& frame, int client, Time when) { wire_.submit(frame, client, when); }
  void drop_client(int client) noexcept { wire_.drop(client); }
  /// Simulates bus and drives until `now`, in order of time.
  void advance(Time now);
  /// Frames for the clients; the caller sends those that are due and erases them.
  [[nodiscard]] std::vector<sim::Delivery>& deliveries() noexcept { return deliveries_; }
  [[nodiscard]] Time wake_at() const noexcept;

  /// The newest state of the device, received at `at`.
  void take(const DeviceState& state, Time at) noexcept;
  /// Force for the device. Zero while it is silent, while a drive is off, and after a drive's own watchdog.
  [[nodiscard]] Vec force_D_N() const noexcept;
  /// Whether the device has been heard within the time of silence. While it is silent the drives are switched off, as
  /// if their power had failed: they make no torque and do not answer SYNC. They start up again when it is back.
  [[nodiscard]] bool is_heard() const noexcept { return is_on_; }
  /// Oldest state that answers a SYNC: the delay for which the record admits stiffness leaves so much. An older one
  /// would be a sample of another moment, and would hide a release of the dead-man. The firmware takes the missing
  /// answer as a lost sample.
  [[nodiscard]] static Time oldest_sample(const device::Device& record);
  [[nodiscard]] const SampleAges& ages() const noexcept { return ages_; }
  [[nodiscard]] const std::array<sim::DriveNode, 3>& nodes() const noexcept { return nodes_; }

 private:
  void hear(const sim::Transmission& heard);
  [[nodiscard]] bool answers(Time at) noexcept;
  void poll(Time now);
  void watch(Time now);
  void send(std::size_t drive, Time now);
  [[nodiscard]] sim::Sensed sensed(std::size_t drive) const noexcept;

  sim::Linkage linkage_;
  sim::DriveConstants constants_;
  Time silence_, oldest_, now_;
  sim::Wire wire_;
  std::array<sim::DriveNode, 3> nodes_;
  std::vector<sim::Delivery> deliveries_;
  std::vector<can::Frame> outgoing_;
  std::optional<Time> heard_at_;
  DeviceState state_;
  bool is_on_ = false;
  SampleAges ages_;
};

/// Why this record cannot describe a bridged device that is asked once in `exchange`; empty: it can.
[[nodiscard]] std::string objection_to(const device::Device& record, Time exchange);

}  // namespace ligature::bridge
