#include "sim_device/fault_injector.hpp"

#include <algorithm>
#include <utility>

#include "protocol/can/codec.hpp"
#include "protocol/can/emcy.hpp"
#include "protocol/can/heartbeat.hpp"
#include "protocol/can/nmt.hpp"
#include "protocol/can/sdo.hpp"
#include "protocol/scene/random.hpp"

namespace ligature::sim {
namespace {

using scene::FaultKind;
using scene::ForeignFrame;

constexpr std::uint16_t kGenericError = 0x1000;

Time time_of(double seconds) { return Time(static_cast<std::int64_t>(seconds * 1e9)); }

}  // namespace

void FaultInjector::apply(HandDevice& device, Time now) {
  if (device.bus_stats().syncs == 0) return;
  if (onset_ == kNever) {
    onset_ = device.bus_stats().first_sync + time_of(script_.from_s);
    end_ = script_.until_s < 1e6 ? device.bus_stats().first_sync + time_of(script_.until_s) : kNever;
  }
  once(device, now);
  for (; next_foreign_ <= now && next_foreign_ < end_; next_foreign_ += time_of(script_.period_s))
    send_foreign(device, now);
  auto& deliveries = device.deliveries();
  std::vector<Delivery> changed;
  for (Delivery& d : deliveries) {
    const bool from_drive = d.sender < HandDevice::kFirstClient;
    if (std::exchange(d.passed_faults, true) || !from_drive)
      changed.push_back(d);
    else
      change(d, changed);
  }
  std::ranges::stable_sort(changed, {}, &Delivery::due);
  deliveries = std::move(changed);
}

void FaultInjector::once(HandDevice& device, Time now) {
  if (done_once_ || now < onset_) return;
  done_once_ = true;
  const can::NodeId node{static_cast<std::uint8_t>(std::max(script_.node, 1))};
  const std::size_t drive = node.value - 1U;
  if (script_.kind == FaultKind::kReboot) device.restart(drive, now);
  if (script_.kind == FaultKind::kEmergency)
    device.submit(can::encode(can::Emergency{node, kGenericError, can::emcy::kGenericBit}), HandDevice::kStranger, now);
  if (script_.kind == FaultKind::kAstray) device.lead_astray(drive, static_cast<std::int16_t>(script_.permille));
  if (script_.kind == FaultKind::kForeign) next_foreign_ = now;
}

/// Sends a frame as a second controller would; `node` 0 means all of the hand's drives.
void FaultInjector::send_foreign(HandDevice& device, Time now) const {
  const auto put = [&](const can::Frame& f) { device.submit(f, HandDevice::kStranger, now); };
  const can::NodeId target{static_cast<std::uint8_t>(script_.node)};
  const auto to_each = [&](auto frame_for) {
    for (const can::NodeId n : can::profile::kJointNodes)
      if (script_.node == 0 || n == target) put(frame_for(n));
  };
  const auto torque = static_cast<std::int16_t>(script_.permille);
  switch (script_.frame) {
    case ForeignFrame::kRpdo:
      return to_each([&](can::NodeId n) {
        return can::encode(n, can::Rpdo1{can::cia402::kControlEnableOperation, torque});
      });
    case ForeignFrame::kSync:
      return put(can::sync_frame());
    case ForeignFrame::kHeartbeat:
      return put(can::encode(can::Heartbeat{can::kMasterNode, can::NmtState::kOperational}));
    case ForeignFrame::kNmtStart:
      return put(can::encode_nmt(can::NmtCommand::kStart, target));
    case ForeignFrame::kNmtStop:
      return put(can::encode_nmt(can::NmtCommand::kStop, target));
    case ForeignFrame::kNmtReset:
      return put(can::encode_nmt(can::NmtCommand::kResetNode, target));
    case ForeignFrame::kSdoRead:
      return to_each([](can::NodeId n) { return can::sdo_read(n, can::od::kStatusword); });
    case ForeignFrame::kSdoWrite:  // switches off the RPDO watchdog
      return to_each([](can::NodeId n) { return can::sdo_write(n, can::od::kRpdo1EventTimer, 0, 2); });
  }
}

bool FaultInjector::is_hit(const Delivery& d) {
  if (d.due < onset_ || d.due >= end_) return false;
  const auto address = can::address_of(d.frame.id);
  if (!address || (script_.node != 0 && address->node.value != script_.node)) return false;
  return scene::share(random_) < script_.share;
}

void FaultInjector::change(const Delivery& delivery, std::vector<Delivery>& out) {
  Delivery d = delivery;
  const bool hit = is_hit(d);
  d.frame = with_wrong_reading(d.frame, hit);
  if (held_) {  // a frame was held back (kReorder): it follows this one at once
    out.push_back(d);
    held_->due = d.due;
    out.push_back(*held_);
    held_.reset();
    return;
  }
  if (!hit) return out.push_back(d);
  switch (script_.kind) {
    case FaultKind::kLose:
      return;
    case FaultKind::kDelay:
      d.due += time_of(script_.delay_s);
      return out.push_back(d);
    case FaultKind::kDuplicate:
      out.push_back(d);
      return out.push_back(d);
    case FaultKind::kReorder:
      held_ = d;
      return;
    case FaultKind::kCorrupt:
      if (d.frame.dlc > 0) d.frame.data[random_() % d.frame.dlc] ^= static_cast<std::uint8_t>(1U << (random_() % 8));
      return out.push_back(d);
    default:
      return out.push_back(d);
  }
}

/// Replaces the readings in a joint message while the fault is active. Before that it stores the true readings, from
/// which the wrong ones are made.
can::Frame FaultInjector::with_wrong_reading(const can::Frame& frame, bool active) {
  const auto address = can::address_of(frame.id);
  if (!address || address->service != can::Service::kTpdo1) return frame;
  const std::size_t joint = address->node.value - 1U;
  auto tpdo = can::decode_tpdo1(address->node, frame);
  if (!tpdo || joint >= before_counts_.size()) return frame;
  if (!active) {
    before_counts_[joint] = tpdo->position_counts;
    if (can::profile::has_stylus_buttons(address->node)) before_buttons_ = tpdo->buttons;
    return frame;
  }
  switch (script_.kind) {
    case FaultKind::kFreeze:
      tpdo->position_counts = before_counts_[joint];
      break;
    case FaultKind::kJump:
      tpdo->position_counts += script_.counts;
      break;
    case FaultKind::kReverse:
      tpdo->position_counts = 2 * before_counts_[joint] - tpdo->position_counts;
      break;
    case FaultKind::kButton:
      if (can::profile::has_stylus_buttons(address->node)) tpdo->buttons = before_buttons_;
      break;
    default:
      return frame;
  }
  return can::encode(address->node, *tpdo);
}

}  // namespace ligature::sim
