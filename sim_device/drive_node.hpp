#pragma once
// One simulated CiA 402 servo drive in cyclic synchronous torque mode, as seen from its CAN connector.

#include <array>
#include <cstdint>
#include <vector>

#include "protocol/can/cia402.hpp"
#include "protocol/can/codec.hpp"
#include "protocol/can/emcy.hpp"
#include "protocol/can/heartbeat.hpp"
#include "protocol/can/nmt.hpp"
#include "sim_device/deadline.hpp"
#include "sim_device/object_dictionary.hpp"

namespace ligature::sim {

/// What the drive's sensors read at a moment.
struct Sensed {
  std::int32_t position_counts = 0;
  std::uint16_t buttons = 0;
  bool guarded = false;              ///< the power stage keeps the torque below what is asked, to spare the winding
  std::int16_t torque_permille = 0;  ///< that it lets through then
};

struct DriveStats {
  std::int64_t watchdog_trips = 0;      ///< times the drive took torque away by itself
  std::int64_t syncs_without_rpdo = 0;  ///< while operation enabled
  std::int64_t late_rpdos = 0;          ///< second RPDO between two SYNCs: the first one never acted
};

/// At a SYNC the drive first latches its inputs into the TPDO, then acts on the RPDO it holds; an RPDO that comes after
/// the SYNC waits for the next one. Silence of RPDOs (0x1400:05) or of the master's heartbeat (0x1016:01) takes torque
/// away at once, is told by EMCY, and latches a fault that only a fault reset leaves. Every call appends what the drive
/// sends to `out`. Time must not run backwards.
class DriveNode {
 public:
  explicit DriveNode(can::NodeId id, const DriveConstants& constants = {}) : id_(id), objects_(id, constants) {}

  void power_on(Time now, std::vector<can::Frame>& out);
  void on_frame(const can::Frame& frame, Time now, const Sensed& sensed, std::vector<can::Frame>& out);
  /// Looks at the clock: watchdogs and the drive's own heartbeat. Due again at next_deadline().
  void poll(Time now, std::vector<can::Frame>& out);
  [[nodiscard]] Time next_deadline() const noexcept;
  /// Power off: no torque from here on.
  void power_off() noexcept;
  /// Its current loop is out of order: while the power stage is on it makes so much more than it was asked for.
  void go_astray(std::int16_t by_permille) noexcept { astray_permille_ = by_permille; }

  [[nodiscard]] can::NodeId id() const noexcept { return id_; }
  [[nodiscard]] can::cia402::State state() const noexcept { return state_; }
  [[nodiscard]] can::NmtState nmt_state() const noexcept { return nmt_; }
  /// Torque the motor makes now, per mille of rated.
  [[nodiscard]] std::int16_t torque_permille() const noexcept;
  [[nodiscard]] const DriveStats& stats() const noexcept { return stats_; }

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
  ObjectDictionary objects_;
  can::NmtState nmt_ = can::NmtState::kBootUp;
  can::cia402::State state_ = can::cia402::State::kNotReadyToSwitchOn;
  can::Rpdo1 received_;               ///< written by the bus at any time
  bool has_received_ = false;         ///< since the last SYNC
  can::Rpdo1 acting_;                 ///< taken over from received_ at SYNC
  std::int16_t torque_permille_ = 0;  // as asked for
  std::int16_t astray_permille_ = 0;
  std::uint8_t life_ = 0;  // of the buttons
  int held_syncs_ = 0;     // the acting torque's RPDO is so many SYNCs older than it should be
  bool is_limited_ = false;
  Deadline rpdo_watch_, master_watch_, own_heartbeat_;
  DriveStats stats_;
};

}  // namespace ligature::sim
