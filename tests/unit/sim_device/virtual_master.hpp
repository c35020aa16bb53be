#pragma once
// A scripted CANopen master on the simulated CAN bus, in virtual time; it takes the controller's place.

#include <array>
#include <chrono>
#include <optional>
#include <vector>

#include "protocol/can/codec.hpp"
#include "protocol/can/emcy.hpp"
#include "protocol/can/nmt.hpp"
#include "protocol/can/startup.hpp"
#include "sim_device/hand_device.hpp"

namespace ligature::sim {

class VirtualMaster {
 public:
  explicit VirtualMaster(HandDevice& device, Time start) : device_(device), now_(start) {}

  /// Puts a frame on the wire now.
  void send(const can::Frame& f) { device_.submit(f, HandDevice::kFirstClient, now_); }

  /// Advances time to every moment that the device asks for, and then to the end, as a real loop would.
  void pass(Time span) {
    const Time end = now_ + span;
    for (;;) {
      device_.advance(now_);
      take_deliveries();
      if (now_ >= end) return;
      now_ = std::min(std::max(device_.wake_at(1), now_ + std::chrono::microseconds(1)), end);
    }
  }

  /// Sends Reset Communication, all start-up writes one by one, and NMT start. @return true when every write was
  /// accepted.
  bool start_up(const can::StartupTimes& times = {}) {
    send(can::encode_nmt(can::NmtCommand::kResetCommunication));
    pass(std::chrono::milliseconds(2));
    for (const can::NodeId node : can::profile::kJointNodes) {
      for (const can::SdoWrite& w : can::startup_plan(node, times)) {
        answer_.reset();
        send(can::sdo_write(node, w.object, w.value, w.bytes));
        pass(std::chrono::milliseconds(1));
        if (!answer_ || answer_->kind != can::SdoKind::kWritten || answer_->node != node) return false;
      }
    }
    send(can::encode_nmt(can::NmtCommand::kStart));
    pass(std::chrono::milliseconds(1));
    return true;
  }

  /// One period: SYNC, wait for the TPDOs, RPDOs with these torques and the transitions to Operation Enabled.
  void tick(const std::array<std::int16_t, 3>& torque_permille = {}) {
    const Time end = now_ + HandDevice::kPeriod;
    if (ticks++ % 100 == 0) send(can::encode(can::Heartbeat{can::kMasterNode, can::NmtState::kOperational}));
    send(can::sync_frame());
    pass(std::chrono::microseconds(600));
    for (std::size_t i = 0; i < 3; ++i) {
      const auto state = can::cia402::state_of(tpdo[i].statusword).value_or(can::cia402::State::kFault);
      const std::uint16_t word = reset_faults && state == can::cia402::State::kFault && ticks % 2 == 0
                                     ? can::cia402::kControlFaultReset
                                     : can::cia402::controlword_towards_operation(state);
      send(can::encode(can::profile::kJointNodes[i], can::Rpdo1{word, torque_permille[i]}));
    }
    pass(end - now_);
  }

  bool enable(int within_ticks = 10) {
    for (int i = 0; i < within_ticks; ++i) {
      tick();
      if (all_in(can::cia402::State::kOperationEnabled)) return true;
    }
    return false;
  }

  [[nodiscard]] bool all_in(can::cia402::State state) const {
    return std::all_of(tpdo.begin(), tpdo.end(),
                       [&](const can::Tpdo1& t) { return can::cia402::state_of(t.statusword) == state; });
  }

  [[nodiscard]] Time now() const { return now_; }

  std::array<can::Tpdo1, 3> tpdo{};
  std::vector<can::Emergency> emergencies;
  std::vector<can::Heartbeat> heartbeats;
  std::vector<Time> tpdo_times;  // relative to the SYNC of their period
  bool reset_faults = false;
  long ticks = 0;

 private:
  void take_deliveries() {
    auto& out = device_.deliveries();
    std::size_t taken = 0;
    for (; taken < out.size() && out[taken].due <= now_; ++taken) {
      const Delivery& d = out[taken];
      if (can::is_sync(d.frame)) sync_at_ = d.due;
      if (d.sender >= HandDevice::kFirstClient) continue;
      for (std::size_t i = 0; i < 3; ++i) {
        if (const auto t = can::decode_tpdo1(can::profile::kJointNodes[i], d.frame)) {
          tpdo[i] = *t;
          tpdo_times.push_back(d.due - sync_at_);
        }
      }
      if (const auto e = can::decode_emergency(d.frame)) emergencies.push_back(*e);
      if (const auto h = can::decode_heartbeat(d.frame)) heartbeats.push_back(*h);
      if (const auto s = can::decode_sdo(d.frame)) answer_ = s;
    }
    out.erase(out.begin(), out.begin() + static_cast<std::ptrdiff_t>(taken));
  }

  HandDevice& device_;
  Time now_;
  Time sync_at_{};
  std::optional<can::Sdo> answer_;
};

/// A path that rests at home, or moves through keys given in world metres.
inline OperatorPath path_of(const std::vector<scene::GripKey>& keys = {}) {
  scene::Hands hands;
  hands.workspace_scale = 20.0;
  hands.workspace_origin_m = {0.5, -0.4, 3.2};
  return std::get<OperatorPath>(OperatorPath::make(keys, WorkspaceMap(hands)));
}

}  // namespace ligature::sim
