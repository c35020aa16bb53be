#pragma once
// Cyclic traffic of one hand's bus: SYNC out, three TPDOs in, three RPDOs out; detects faults and foreign frames.

#include <array>
#include <cstdint>

#include "firmware/platform/link_bus.hpp"
#include "firmware/rt/rig_io.hpp"
#include "protocol/can/cia402.hpp"
#include "protocol/can/codec.hpp"
#include "protocol/device/device.hpp"

namespace ligature::platform {

/// Controlword for a request and the drive's state. A fault reset acts on a rising edge, so the controlword then
/// alternates with zero.
[[nodiscard]] constexpr std::uint16_t controlword(rt::DriveRequest request, can::cia402::State state,
                                                  std::uint16_t before) noexcept {
  using can::cia402::State;
  switch (request) {
    case rt::DriveRequest::kHold:
    case rt::DriveRequest::kStop:
      return can::cia402::kControlDisableVoltage;
    case rt::DriveRequest::kEnable:
      if (state == State::kFault) {
        return before == can::cia402::kControlFaultReset ? can::cia402::kControlDisableVoltage
                                                         : can::cia402::kControlFaultReset;
      }
      return can::cia402::controlword_towards_operation(state);
    case rt::DriveRequest::kOperate:
      return state == State::kOperationEnabled ? can::cia402::kControlEnableOperation
                                               : can::cia402::kControlDisableVoltage;
  }
  return can::cia402::kControlDisableVoltage;
}

/// Whether a drive in this state has no torque. In quick stop and in the reaction to a fault the drive may still brake,
/// so these states do not count as off.
[[nodiscard]] constexpr bool is_off(can::cia402::State state) noexcept {
  using can::cia402::State;
  return state != State::kOperationEnabled && state != State::kQuickStopActive && state != State::kFaultReactionActive;
}

/// Real time: every call is bounded, does not allocate, and makes only the bus's system calls.
class HandLink {
 public:
  static constexpr int kHeartbeatPeriods = 50;  ///< half of our drives' timeout, so that one may be lost

  /// @param hand index; the right hand's heartbeats are sent in other periods than the left one's
  HandLink(CanBus& bus, const device::Device& device, int heartbeat_periods = kHeartbeatPeriods,
           std::size_t hand = 0) noexcept;

  /// Begins a period: first reads late frames of the last period (as one period old), then sends SYNC. After a write()
  /// with kStop, NMT stop follows each SYNC.
  void send_sync() noexcept;

  /// Reads all frames that have arrived.
  void drain() noexcept;

  /// Whether waiting is over: all drives have answered this period's SYNC, or the bus is lost.
  [[nodiscard]] bool is_settled() const noexcept { return age_ticks_ == 0 || bus_.is_lost(); }
  [[nodiscard]] rt::HandReading reading() const noexcept;

  /// Sends the torques. They are sent in every period, so that a foreign controller's RPDO acts for one period at most.
  /// Every heartbeat_periods the master's heartbeat is sent before them, if may_beat() is true.
  /// @return the torques as sent, per mille; zero if the bus is lost
  std::array<std::int16_t, rt::kJoints> write(const rt::HandCommand& command) noexcept;

 private:
  static constexpr int kStillSets = 10;  // complete sets without a change of the buttons' counter
  static constexpr int kObey = 10;       // periods that drives have to switch off

  struct Node {
    can::Tpdo1 latest;
    std::uint16_t emergency = 0;  // error code, 0 = none
    bool operational = true;      // according to its heartbeat
    std::uint16_t controlword = 0;
    [[nodiscard]] can::cia402::State state() const noexcept;
  };

  [[nodiscard]] bool may_beat(rt::DriveRequest request) noexcept;
  [[nodiscard]] bool are_off() const noexcept;
  void beat() noexcept;
  void take(const can::Frame& frame) noexcept;
  [[nodiscard]] std::int16_t permille_of(double torque_Nm) const noexcept;
  void note_life(std::uint16_t buttons) noexcept;
  void take_tpdo(std::size_t joint, const can::Tpdo1& tpdo) noexcept;
  void take_part(unsigned part) noexcept;
  void tell_buttons(rt::HandReading& r) const noexcept;
  [[nodiscard]] bool has_word(std::size_t joint) const noexcept;

  LinkBus bus_;
  double rad_per_count_, Nm_per_permille_;
  std::int32_t max_permille_, tolerance_permille_;
  device::ButtonsPlace buttons_;
  std::size_t buttons_joint_;
  std::uint32_t inputs_id_;  ///< of the TPDO with plain inputs; 0: there is none
  unsigned complete_;        ///< the parts of a complete set, one bit each
  std::array<Node, rt::kJoints> nodes_{};
  std::array<can::Tpdo1, rt::kJoints> pending_{};
  std::uint32_t inputs_ = 0, pending_inputs_ = 0;
  unsigned arrived_ = 0;  // parts that came since the last SYNC
  bool valid_ = false;
  rt::Foreign foreign_ = rt::Foreign::kNone;
  bool stops_ = false;     // the last request was kStop
  int periods_on_ = 0;     // in a row, in which the drives should be off and may not be
  bool has_life_ = false;  // the buttons' counter was seen to change; a drive without one is not checked
  int still_sets_ = 0;
  std::int32_t age_ticks_ = 1;
  int heartbeat_periods_, periods_to_heartbeat_;
};

}  // namespace ligature::platform
