#include "sim_device/drive_node.hpp"

#include <algorithm>
#include <cstdlib>
#include <limits>

namespace ligature::sim {

namespace cia402 = can::cia402;
namespace od = can::od;
using cia402::Event;
using cia402::State;
using std::chrono::milliseconds;

void DriveNode::power_on(Time now, std::vector<can::Frame>& out) {
  objects_.reset();
  state_ = cia402::next(State::kNotReadyToSwitchOn, Event::kInitialised);
  boot(now, out);
}

void DriveNode::power_off() noexcept {
  take_torque_away();
  nmt_ = can::NmtState::kStopped;
  state_ = State::kNotReadyToSwitchOn;
}

/// Enters pre-operational: sends boot-up once and discards all earlier commands.
void DriveNode::boot(Time now, std::vector<can::Frame>& out) {
  take_torque_away();
  received_ = acting_ = can::Rpdo1{};
  has_received_ = false;
  rpdo_watch_.disarm();
  master_watch_.disarm();
  own_heartbeat_.disarm();
  const auto period = milliseconds(objects_.value(od::kProducerHeartbeat));
  if (period > milliseconds(0)) own_heartbeat_.arm(now + period);
  out.push_back(can::encode(can::Heartbeat{id_, can::NmtState::kBootUp}));
  nmt_ = can::NmtState::kPreOperational;
}

void DriveNode::on_frame(const can::Frame& frame, Time now, const Sensed& sensed, std::vector<can::Frame>& out) {
  const auto address = can::address_of(frame.id);
  if (!address) return;
  switch (address->service) {
    case can::Service::kNmt:
      if (const auto m = can::decode_nmt(frame); m && m->is_for(id_)) on_nmt(*m, now, out);
      break;
    case can::Service::kSync:
      if (is_operational()) on_sync(sensed, out);
      break;
    case can::Service::kRpdo1:
      if (const auto r = can::decode_rpdo1(id_, frame); r && is_operational() && objects_.is_pdo_on(can::Pdo::kRpdo1)) {
        on_rpdo(*r, now);
      }
      break;
    case can::Service::kSdoRequest:
      if (const auto s = can::decode_sdo(frame); s && s->node == id_ && nmt_ != can::NmtState::kStopped)
        on_sdo(*s, now, out);
      break;
    case can::Service::kHeartbeat:
      if (address->node == can::kMasterNode) on_master_heartbeat(now);
      break;
    case can::Service::kEmcy:
    case can::Service::kTpdo1:
    case can::Service::kSdoResponse:
      break;  // sent by other nodes
  }
}

Meaning DriveNode::meaning_of(const can::Frame& frame) const noexcept {
  if (can::is_sync(frame)) return Meaning::kPeriod;
  if (frame.id == can::kNmtCobId.value) return Meaning::kState;
  const auto address = can::address_of(frame.id);
  if (address && address->service == can::Service::kRpdo1) return Meaning::kTorqueAtSync;
  return address && address->service == can::Service::kHeartbeat ? Meaning::kSilent : Meaning::kOther;
}

void DriveNode::on_nmt(const can::NmtMessage& message, Time now, std::vector<can::Frame>& out) {
  switch (message.command) {
    case can::NmtCommand::kStart:
      nmt_ = can::NmtState::kOperational;
      return;
    case can::NmtCommand::kStop:
      nmt_ = can::NmtState::kStopped;
      break;
    case can::NmtCommand::kEnterPreOperational:
      nmt_ = can::NmtState::kPreOperational;
      break;
    case can::NmtCommand::kResetNode:
      power_on(now, out);
      return;
    case can::NmtCommand::kResetCommunication:
      objects_.reset_communication();
      boot(now, out);
      break;
  }
  // Outside of the NMT state operational the drive obeys no RPDO. So its torque is removed here; that is no fault, but
  // the drive must be enabled again.
  take_torque_away();
  rpdo_watch_.disarm();
  has_received_ = false;
  acting_ = can::Rpdo1{};
  state_ = cia402::next(state_, Event::kDisableVoltage);
}

void DriveNode::on_sync(const Sensed& sensed, std::vector<can::Frame>& out) {
  if (objects_.is_pdo_on(can::Pdo::kTpdo1)) {
    const auto buttons = can::profile::with_life(can::profile::with_held(sensed.buttons, held_syncs_), ++life_);
    const std::int16_t made = sensed.guarded ? sensed.torque_permille : torque_permille();
    send_sample({statusword(sensed.guarded), sensed.position_counts, made, buttons}, sensed, out);
  }
  held_syncs_ = has_received_ ? 0 : held_syncs_ + (held_syncs_ < 31);
  if (has_received_) {
    has_received_ = false;
    act_on(received_, out);
  } else if (state_ == State::kOperationEnabled) {
    ++stats_.syncs_without_rpdo;  // the last torque continues until the watchdog removes it
  }
}

void DriveNode::send_sample(const can::Tpdo1& sample, const Sensed&, std::vector<can::Frame>& out) {
  out.push_back(can::encode(id_, sample));
}

void DriveNode::on_rpdo(const can::Rpdo1& rpdo, Time now) {
  if (has_received_) ++stats_.late_rpdos;
  received_ = rpdo;
  has_received_ = true;
  const auto silence = milliseconds(objects_.value(od::kRpdo1EventTimer));
  if (silence > milliseconds(0)) rpdo_watch_.arm(now + silence);
}

void DriveNode::act_on(const can::Rpdo1& rpdo, std::vector<can::Frame>& out) {
  if (const auto event = cia402::event_of(acting_.controlword, rpdo.controlword)) react(*event, out);
  acting_ = rpdo;
  // 0x605A = 0: quick stop removes the torque at once
  if (state_ == State::kQuickStopActive) react(Event::kDisableVoltage, out);
  if (!cia402::may_produce_torque(state_)) return take_torque_away();
  const auto limit = static_cast<std::int16_t>(objects_.value(od::kMaxTorque));
  torque_permille_ = std::clamp(rpdo.target_torque_permille, static_cast<std::int16_t>(-limit), limit);
  is_limited_ = torque_permille_ != rpdo.target_torque_permille;
}

void DriveNode::react(Event event, std::vector<can::Frame>& out) {
  const bool enables = cia402::next(state_, event) == State::kOperationEnabled;
  if (enables && objects_.value(od::kModeOfOperation) != can::profile::kCyclicSynchronousTorque)
    return;  // the mode of operation has not been set
  const State before = state_;
  state_ = cia402::next(state_, event);
  if (before == State::kFault && state_ != State::kFault) {
    objects_.set(od::kErrorRegister, 0);
    objects_.set(od::kErrorCode, 0);
    out.push_back(can::encode(can::Emergency{id_, can::emcy::kNoError, 0}));
  }
}

void DriveNode::on_sdo(const can::Sdo& request, Time now, std::vector<can::Frame>& out) {
  objects_.set(od::kStatusword, statusword());
  objects_.set(od::kTorqueActual, torque_permille());
  objects_.set(od::kModeOfOperationDisplay, objects_.value(od::kModeOfOperation));
  const auto answer = objects_.serve(request);
  if (!answer) return;
  out.push_back(can::encode(*answer));
  if (answer->kind != can::SdoKind::kWritten) return;
  if (request.object == od::kProducerHeartbeat) {
    const auto period = milliseconds(objects_.value(od::kProducerHeartbeat));
    period > milliseconds(0) ? own_heartbeat_.arm(now + period) : own_heartbeat_.disarm();
  }
  if (request.object == od::kConsumerHeartbeat) master_watch_.disarm();  // monitoring starts with the first heartbeat
}

void DriveNode::on_master_heartbeat(Time now) {
  const auto value = objects_.value(od::kConsumerHeartbeat);
  const auto silence = milliseconds(value & 0xFFFF);
  const bool watched = (value >> 16) == can::kMasterNode.value && silence > milliseconds(0);
  if (watched) master_watch_.arm(now + silence);
}

void DriveNode::poll(Time now, const Sensed&, std::vector<can::Frame>& out) {
  if (rpdo_watch_.is_over(now)) {
    rpdo_watch_.disarm();
    trip(can::emcy::kRpdoTimeout, out);
  }
  if (master_watch_.is_over(now)) {
    master_watch_.disarm();
    trip(can::emcy::kHeartbeatLost, out);
  }
  if (own_heartbeat_.is_over(now)) {
    out.push_back(can::encode(can::Heartbeat{id_, nmt_}));
    own_heartbeat_.arm(std::max(own_heartbeat_.at() + milliseconds(objects_.value(od::kProducerHeartbeat)), now));
  }
}

Time DriveNode::next_deadline() const noexcept {
  return std::min({rpdo_watch_.at(), master_watch_.at(), own_heartbeat_.at()});
}

/// Connection lost: removes the torque first, then latches and reports the fault.
void DriveNode::trip(std::uint16_t code, std::vector<can::Frame>& out) {
  take_torque_away();
  ++stats_.watchdog_trips;
  has_received_ = false;
  if (state_ == State::kFault) return;  // already reported
  react(Event::kFaultDetected, out);
  react(Event::kFaultReactionDone, out);
  const std::uint8_t error_register = can::emcy::kGenericBit | can::emcy::kCommunicationBit;
  objects_.set(od::kErrorRegister, error_register);
  objects_.set(od::kErrorCode, code);
  out.push_back(can::encode(can::Emergency{id_, code, error_register}));
}

std::int16_t DriveNode::torque_permille() const noexcept {
  if (state_ != State::kOperationEnabled) return torque_permille_;
  constexpr int kMost = std::numeric_limits<std::int16_t>::max();
  return static_cast<std::int16_t>(std::clamp(torque_permille_ + astray_permille_, -kMost, kMost));
}

bool DriveNode::is_astray() const noexcept {
  return state_ == State::kOperationEnabled && std::abs(astray_permille_) > can::profile::kTorqueTolerance_permille;
}

void DriveNode::take_torque_away() noexcept {
  torque_permille_ = 0;
  is_limited_ = false;
}

std::uint16_t DriveNode::statusword(bool guarded) const noexcept {
  unsigned word = cia402::statusword_of(state_) | cia402::kVoltageEnabledBit | cia402::kRemoteBit;
  if (is_limited_ || guarded) word |= cia402::kInternalLimitBit;
  if (state_ == State::kOperationEnabled) word |= cia402::kFollowsTargetBit;
  if (is_astray()) word |= cia402::kTorqueAstrayBit;
  return static_cast<std::uint16_t>(word);
}

}  // namespace ligature::sim
