#pragma once
// Three simulated drives on a bus that represent a Cartesian device: the device's position becomes joint angles, and
// the drives' torques become the device's force. Uses no sockets and no clock.

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

/// Age of the device's newest state at each SYNC. This age is the delay that the bridge adds to a position sample.
struct SampleAges {
  std::int64_t syncs = 0;
  std::int64_t stale = 0;   ///< not answered, because the state was too old or the device was silent
  std::int64_t silent = 0;  ///< of these: the device was silent
  Time sum{}, worst{};
};

class Drives {
 public:
  /// @param silence  the device counts as silent when it has sent no state for this time. @param charge_bus_time
  /// whether frames take their transmission time on the simulated bus; false if a real bus takes it.
  Drives(const device::Device& record, Time now, Time silence, bool charge_bus_time = true);

  void submit(const can::Frame& frame, int client, Time when) { wire_.submit(frame, client, when); }
  void drop_client(int client) noexcept { wire_.drop(client); }
  /// Simulates bus and drives until `now`, in order of time.
  void advance(Time now);
  /// Frames for the programs on the bus; the caller sends those that are due and erases them.
  [[nodiscard]] std::vector<sim::Delivery>& deliveries() noexcept { return deliveries_; }
  [[nodiscard]] Time wake_at() const noexcept;

  /// The newest state of the device, received at `at`.
  void take(const DeviceState& state, Time at) noexcept;
  /// The force that the device is to make. It is zero while the device is silent, while a drive is off, and after a
  /// drive's watchdog has expired.
  [[nodiscard]] Vec force_D_N() const noexcept;
  /// Whether the device has sent a state within the constructor's `silence`. While the device is silent, the drives are
  /// switched off, as if their power had failed: they make no torque and do not answer SYNC. They start up again when
  /// the device is back.
  [[nodiscard]] bool is_heard() const noexcept { return is_on_; }
  /// Largest age of a device state with which the drives still answer SYNC: the device record's drives.delay_s, for
  /// which the allowed stiffness is computed, minus one period. With an older state the drives do not answer, and the
  /// firmware counts a lost sample: an old state could hide that the dead-man was released.
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

/// Checks that this record can describe a bridged device to which the bridge speaks once per interval `exchange`.
/// @return the error text; empty when it can.
[[nodiscard]] std::string objection_to(const device::Device& record, Time exchange);

}  // namespace ligature::bridge
