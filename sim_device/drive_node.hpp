#pragma once
// A simulated CiA 402 servo drive in cyclic synchronous torque mode, as it behaves on the CAN bus.

#include <array>
#include <cstdint>
#include <vector>

#include "protocol/can/cia402.hpp"
#include "protocol/can/codec.hpp"
#include "protocol/can/emcy.hpp"
#include "protocol/can/heartbeat.hpp"
#include "protocol/can/nmt.hpp"
#include "sim_device/bus_node.hpp"
#include "sim_device/object_dictionary.hpp"

namespace ligature::sim {

/// At a SYNC the drive first samples its inputs for the TPDO, then applies the RPDO that it holds; an RPDO that comes
/// after the SYNC waits for the next one. If RPDOs (0x1400:05) or the master's heartbeat (0x1016:01) stay away too
/// long, the drive removes its torque at once, sends an EMCY, and latches a fault that only a fault reset clears.
class DriveNode : public BusNode {
 public:
  explicit DriveNode(can::NodeId id, const DriveConstants& constants = {})
      : id_(id), constants_(constants), objects_(id, constants) {}

  void power_on(Time now, std::vector<can::Frame>& out) override;
  void power_off() noexcept override;
  void on_frame(const can::Frame& frame, Time now, const Sensed& sensed, std::vector<can::Frame>& out) override;
  void poll(Time now, const Sensed& sensed, std::vector<can::Frame>& out) override;
  [[nodiscard]] Time next_deadline() const noexcept override;
  [[nodiscard]] Meaning meaning_of(const can::Frame& frame) const noexcept override;
  [[nodiscard]] double torque_Nm() const noexcept override { return constants_.torque_Nm(torque_permille()); }
  [[nodiscard]] bool is_enabled() const noexcept override { return state_ == can::cia402::State::kOperationEnabled; }
  [[nodiscard]] bool has_fault() const noexcept override { return state_ == can::cia402::State::kFault; }
  [[nodiscard]] DriveStats stats() const noexcept override { return stats_; }
  /// Injects a fault: while the power stage is on, the drive makes more torque than commanded, by this amount.
  void go_astray(std::int16_t by_permille) noexcept { astray_permille_ = by_permille; }

  [[nodiscard]] can::NodeId id() const noexcept { return id_; }
  [[nodiscard]] can::cia402::State state() const noexcept { return state_; }
  [[nodiscard]] can::NmtState nmt_state() const noexcept { return nmt_; }
  /// Torque that the motor makes now, per mille of rated torque.
  [[nodiscard]] std::int16_t torque_permille() const noexcept;

 protected:
  /// Sends the answer to a SYNC.
  virtual void send_sample(const can::Tpdo1& sample, const Sensed& sensed, std::vector<can::Frame>& out);

 private:
  void on_nmt(const can::NmtMessage& message, Time now, std::vector<can::Frame>& out);
  void on_sync(const Sensed& sensed, std::vector<can::Frame>& out);
  void on_rpdo(const can::Rpdo1& rpdo, Time now);
  void on_sdo(const can::Sdo& request, Time now, std::vector<can::Frame>& out);
  void on_master_heartbeat(Time now);
  void boot(Time now, std::vector<can::Frame>& out);
  void react(can::cia402::Event event, std::vector<can::Frame>& out);
  void act_on(const can::Rpdo1& rpdo, std::vector<can::Frame>& out);
  void trip(std::uint16_t code, std::vector<can::Frame>& out);
  void take_torque_away() noexcept;
  [[nodiscard]] bool is_astray() const noexcept;
  [[nodiscard]] std::uint16_t statusword(bool guarded = false) const noexcept;
  [[nodiscard]] bool is_operational() const noexcept { return nmt_ == can::NmtState::kOperational; }

  can::NodeId id_;
  DriveConstants constants_;
  ObjectDictionary objects_;
  can::NmtState nmt_ = can::NmtState::kBootUp;
  can::cia402::State state_ = can::cia402::State::kNotReadyToSwitchOn;
  can::Rpdo1 received_;               ///< last RPDO from the bus
  bool has_received_ = false;         ///< an RPDO came since the last SYNC
  can::Rpdo1 acting_;                 ///< copied from received_ at SYNC
  std::int16_t torque_permille_ = 0;  // commanded torque in effect
  std::int16_t astray_permille_ = 0;
  std::uint8_t life_ = 0;  // counter of SYNCs, sent in bits 8 .. 15 of the buttons' word
  int held_syncs_ = 0;     // SYNCs for which the torque was repeated because no RPDO came
  bool is_limited_ = false;
  Deadline rpdo_watch_, master_watch_, own_heartbeat_;
  DriveStats stats_;
};

}  // namespace ligature::sim
