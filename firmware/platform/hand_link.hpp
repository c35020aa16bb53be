#pragma once
// The cyclic part of one hand's bus: SYNC out, three TPDOs in, three RPDOs out, and an ear for trouble.

#include <array>
#include <cstdint>

#include "firmware/platform/can_bus.hpp"
#include "firmware/rt/rig_io.hpp"
#include "protocol/can/cia402.hpp"
#include "protocol/can/codec.hpp"
#include "protocol/device/device.hpp"

namespace ligature::platform {

/// Controlword for a drive in a state, by request. Fault reset is an edge, so it alternates with zero.
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

/// Real time: every call is bounded, allocates nothing, and does at most the bus' system calls.
class HandLink {
 public:
  static constexpr int kHeartbeatPeriods = 50;  ///< half of the drives' default, so that one may be lost

  /// @param first_heartbeat  the period, from 0, that has the first heartbeat of the master
  HandLink(CanBus& bus, const device::Device& device, int first_heartbeat = 0) noexcept
      : bus_(bus),
        rad_per_count_(device.rad_per_count()),
        Nm_per_permille_(device.Nm_per_permille()),
        max_permille_(device.max_torque_permille),
        periods_to_heartbeat_(first_heartbeat) {}

  /// Begins a period. What came too late for the last one is taken first, as one period old; then SYNC goes out.
  void send_sync() noexcept;

  /// Takes what has arrived.
  void drain() noexcept;

  /// All three drives have answered this period's SYNC, or never will.
  [[nodiscard]] bool is_settled() const noexcept { return age_ticks_ == 0 || bus_.is_lost(); }
  [[nodiscard]] rt::HandReading reading() const noexcept;

  /// Every period anew, so that somebody else's frames do not outlast ours; before them, every kHeartbeatPeriods, the
  /// master's heartbeat.
  /// @return the torques as they went out, per mille; zero when the bus is lost.
  std::array<std::int16_t, rt::kJoints> write(const rt::HandCommand& command) noexcept;

 private:
  static constexpr int kMaxFrames = 64;  // a period on a 1 Mbit/s bus carries fewer than 22
  static constexpr int kStillSets = 10;  // complete sets without a new life sign

  struct Node {
    can::Tpdo1 latest;
    std::uint16_t emergency = 0;  // error code, 0 = none
    bool operational = true;      // by its heartbeat
    std::uint16_t controlword = 0;
    [[nodiscard]] can::cia402::State state() const noexcept;
  };

  bool send(const can::Frame& frame) noexcept;
  void beat() noexcept;
  void take(const can::Frame& frame) noexcept;
  [[nodiscard]] std::int16_t permille_of(double torque_Nm) const noexcept;
  void note_life(std::uint16_t buttons) noexcept;
  void take_tpdo(std::size_t joint, const can::Tpdo1& tpdo) noexcept;

  CanBus& bus_;
  double rad_per_count_, Nm_per_permille_;
  std::int32_t max_permille_;
  std::array<Node, rt::kJoints> nodes_{};
  std::array<can::Tpdo1, rt::kJoints> pending_{};
  unsigned arrived_ = 0;  // bit per joint since the last SYNC
  bool valid_ = false;
  bool was_lost_ = false;  // since the last reading; a bus may be back before anybody asks
  rt::Foreign foreign_ = rt::Foreign::kNone;
  bool has_life_ = false;  // the buttons' life sign was seen to move; a drive without one is taken as it is
  int still_sets_ = 0;
  std::int32_t age_ticks_ = 1;
  int periods_to_heartbeat_;
  unsigned bits_ = 0, bits_of_last_period_ = 0;  // on the wire
};

}  // namespace ligature::platform
