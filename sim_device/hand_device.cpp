#include "sim_device/hand_device.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace ligature::sim {

HandDevice::HandDevice(OperatorPath path, Time now, bool charge_bus_time)
    : HandDevice(std::make_unique<OperatorPath>(std::move(path)), now, Body{}, charge_bus_time) {}

HandDevice::HandDevice(std::unique_ptr<Intention> intention, Time now, const Body& body, bool charge_bus_time)
    : wire_(charge_bus_time),
      mechanics_(std::move(intention), now, body),
      drives_{DriveNode(can::kWaist, body.drives), DriveNode(can::kShoulder, body.drives),
              DriveNode(can::kElbow, body.drives)},
      now_(now) {
  for (std::size_t i = 0; i < drives_.size(); ++i) {
    drives_[i].power_on(now, outgoing_);
    send(i, now);
  }
}

void HandDevice::submit(const can::Frame& frame, int client, Time when) { wire_.submit(frame, client, when); }

void HandDevice::advance(Time now) {
  while (const auto heard = wire_.advance(now)) hear(*heard);
  poll(now);
}

/// Advances the time before handling the frame, so that a watchdog that expired before the frame's end acts first.
void HandDevice::hear(const Transmission& heard) {
  poll(heard.end);
  const bool changes_torque = can::is_sync(heard.frame) || heard.frame.id == can::kNmtCobId.value;
  if (changes_torque) move(heard.end);
  note(heard.frame, heard.end);
  for (std::size_t i = 0; i < drives_.size(); ++i) {
    if (static_cast<int>(i) == heard.sender) continue;
    const bool stylus = can::profile::has_stylus_buttons(drives_[i].id());
    const auto joint = static_cast<Eigen::Index>(i);
    const double per_permille = mechanics_.body().drives.torque_Nm(1);
    const Sensed sensed{mechanics_.counts(static_cast<int>(i)), stylus ? mechanics_.buttons() : std::uint16_t{0},
                        mechanics_.motors().is_holding(joint),
                        static_cast<std::int16_t>(std::lround(mechanics_.made_Nm()[joint] / per_permille))};
    drives_[i].on_frame(heard.frame, heard.end, sensed, outgoing_);
    send(i, heard.end);
  }
  const auto enabled = [](const DriveNode& d) { return d.state() == can::cia402::State::kOperationEnabled; };
  if (can::is_sync(heard.frame))
    mechanics_.feel_drives(std::all_of(drives_.begin(), drives_.end(), enabled), heard.end);
  deliveries_.push_back({heard.frame, heard.sender, heard.end});
}

void HandDevice::poll(Time now) {
  now_ = std::max(now_, now);
  for (std::size_t i = 0; i < drives_.size(); ++i) {
    const Time due = drives_[i].next_deadline();
    if (due > now_) continue;
    move(due);  // the torque lasts until the watchdog expires
    drives_[i].poll(now_, outgoing_);
    send(i, due);
  }
  if (now_ - bus_.last_sync > kPeriod) move(now_);  // without SYNCs nothing else advances the mechanics
}

void HandDevice::move(Time now) noexcept {
  const auto t = torque_permille();
  const DriveConstants& drive = mechanics_.body().drives;
  mechanics_.advance(now, {drive.torque_Nm(t[0]), drive.torque_Nm(t[1]), drive.torque_Nm(t[2])});
}

void HandDevice::send(std::size_t drive, Time now) {
  for (const can::Frame& f : outgoing_) wire_.submit(f, static_cast<int>(drive), now);
  outgoing_.clear();
}

void HandDevice::note(const can::Frame& frame, Time end) noexcept {
  const auto address = can::address_of(frame.id);
  if (address && address->service == can::Service::kRpdo1 && bus_.syncs > 0) {
    bus_.worst_rpdo = std::max(bus_.worst_rpdo, end - bus_.last_sync);
  }
  if (!can::is_sync(frame)) return;
  if (bus_.syncs++ == 0) {
    bus_.first_sync = end;
    bus_.busy_at_first_sync = wire_.stats().busy;
  } else {
    const auto periods = (end - bus_.last_sync + kPeriod / 2) / kPeriod;
    if (periods > 1) bus_.missed_syncs += periods - 1;
  }
  bus_.last_sync = end;
}

Time HandDevice::wake_at(int listeners) const noexcept {
  Time at = kNever;
  for (const DriveNode& d : drives_) at = std::min(at, d.next_deadline());
  // With a single controller on the bus, frames that no drive answers (the controller's RPDOs and heartbeats) need no
  // wake-up of their own.
  const auto matters = [&](const can::Frame& f, int sender) {
    const auto address = can::address_of(f.id);
    const bool silent =
        address && (address->service == can::Service::kRpdo1 || address->service == can::Service::kHeartbeat);
    return listeners > 1 || sender < kFirstClient || !silent;
  };
  const bool to_send = std::any_of(deliveries_.begin(), deliveries_.end(),
                                   [&](const Delivery& d) { return listeners > 1 || d.sender < kFirstClient; });
  if (wire_.any_pending(matters)) return std::min(at, wire_.quiet_at());
  return to_send ? std::min(at, deliveries_.back().due) : at;
}

void HandDevice::restart(std::size_t drive, Time now) {
  move(now);
  drives_[drive].power_off();
  drives_[drive].power_on(now, outgoing_);
  send(drive, now);
}

void HandDevice::power_off() noexcept {
  for (DriveNode& d : drives_) d.power_off();
}

std::array<std::int16_t, 3> HandDevice::torque_permille() const noexcept {
  return {drives_[0].torque_permille(), drives_[1].torque_permille(), drives_[2].torque_permille()};
}

double HandDevice::bus_load() const noexcept {
  const Time span = bus_.last_sync - bus_.first_sync;
  if (span <= Time(0)) return 0.0;
  return static_cast<double>((wire_.stats().busy - bus_.busy_at_first_sync).count()) /
         static_cast<double>(span.count());
}

}  // namespace ligature::sim
