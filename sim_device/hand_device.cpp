#include "sim_device/hand_device.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace ligature::sim {

HandDevice::HandDevice(OperatorPath path, Time now, bool charge_bus_time)
    : HandDevice(std::make_unique<OperatorPath>(std::move(path)), now, Body{}, charge_bus_time) {}

HandDevice::HandDevice(std::unique_ptr<Intention> intention, Time now, const Body& body, bool charge_bus_time)
    : HandDevice(std::move(intention), now, body, charge_bus_time,
                 {std::make_unique<DriveNode>(can::kWaist, body.drives),
                  std::make_unique<DriveNode>(can::kShoulder, body.drives),
                  std::make_unique<DriveNode>(can::kElbow, body.drives)}) {}

HandDevice::HandDevice(std::unique_ptr<Intention> intention, Time now, const Body& body, bool charge_bus_time,
                       BusNodes drives)
    : wire_(charge_bus_time), mechanics_(std::move(intention), now, body), drives_(std::move(drives)), now_(now) {
  for (std::size_t i = 0; i < drives_.size(); ++i) {
    drives_[i]->power_on(now, outgoing_);
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
  const Meaning meaning = heard.sender < kFirstClient ? Meaning::kOther : drives_[0]->meaning_of(heard.frame);
  if (meaning == Meaning::kPeriod || meaning == Meaning::kState || meaning == Meaning::kTorque) move(heard.end);
  note(meaning, heard.end);
  for (std::size_t i = 0; i < drives_.size(); ++i) {
    if (static_cast<int>(i) == heard.sender) continue;
    drives_[i]->on_frame(heard.frame, heard.end, sensed(i), outgoing_);
    send(i, heard.end);
  }
  feel_drives(meaning, heard.end);
  deliveries_.push_back({heard.frame, heard.sender, heard.end});
}

/// The operator starts when the drives are on, and not only for a trial.
void HandDevice::feel_drives(Meaning meaning, Time end) noexcept {
  had_torque_ = had_torque_ || meaning == Meaning::kTorque;
  if (meaning != Meaning::kPeriod) return;
  const bool all_on = std::ranges::all_of(drives_, [](const auto& d) { return d->is_enabled(); });
  const bool had_torque = std::exchange(had_torque_, false);
  regular_periods_ = all_on && had_torque ? regular_periods_ + 1 : 0;
  const bool is_known = mechanics_.has_started() || regular_periods_ >= drives_[0]->trial_periods();
  mechanics_.feel_drives(all_on && is_known, end);
}

Sensed HandDevice::sensed(std::size_t drive) const noexcept {
  const auto joint = static_cast<Eigen::Index>(drive);
  const double per_permille = mechanics_.body().drives.torque_Nm(1);
  return {mechanics_.counts(static_cast<int>(drive)), mechanics_.buttons(), mechanics_.motors().is_holding(joint),
          static_cast<std::int16_t>(std::lround(mechanics_.made_Nm()[joint] / per_permille)),
          mechanics_.plant().omega_rad_per_s()[joint]};
}

void HandDevice::poll(Time now) {
  now_ = std::max(now_, now);
  for (std::size_t i = 0; i < drives_.size(); ++i) {
    const Time due = drives_[i]->next_deadline();
    if (due > now_) continue;
    move(due);  // the torque lasts until the watchdog expires
    drives_[i]->poll(now_, sensed(i), outgoing_);
    send(i, due);
  }
  if (now_ - bus_.last_sync > kPeriod) move(now_);  // without SYNCs nothing else advances the mechanics
}

void HandDevice::move(Time now) noexcept {
  mechanics_.advance(now, {drives_[0]->torque_Nm(), drives_[1]->torque_Nm(), drives_[2]->torque_Nm()});
}

void HandDevice::send(std::size_t drive, Time now) {
  for (const can::Frame& f : outgoing_) wire_.submit(f, static_cast<int>(drive), now);
  outgoing_.clear();
}

void HandDevice::note(Meaning meaning, Time end) noexcept {
  if (drives_[0]->trial_periods() > 0 && !mechanics_.has_started()) return;  // trials are no periods of the loop
  if ((meaning == Meaning::kTorque || meaning == Meaning::kTorqueAtSync) && bus_.syncs > 0)
    bus_.worst_rpdo = std::max(bus_.worst_rpdo, end - bus_.last_sync);
  if (meaning != Meaning::kPeriod) return;
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
  for (const auto& d : drives_) at = std::min(at, d->next_deadline());
  // With a single controller on the bus, frames that no drive answers (the controller's torques and heartbeats) need no
  // wake-up of their own.
  const auto matters = [&](const can::Frame& f, int sender) {
    if (listeners > 1 || sender < kFirstClient) return true;
    const Meaning meaning = drives_[0]->meaning_of(f);
    return meaning != Meaning::kTorque && meaning != Meaning::kTorqueAtSync && meaning != Meaning::kSilent;
  };
  const bool to_send = std::any_of(deliveries_.begin(), deliveries_.end(),
                                   [&](const Delivery& d) { return listeners > 1 || d.sender < kFirstClient; });
  if (wire_.any_pending(matters)) return std::min(at, wire_.quiet_at());
  return to_send ? std::min(at, deliveries_.back().due) : at;
}

void HandDevice::restart(std::size_t drive, Time now) {
  move(now);
  drives_[drive]->power_off();
  drives_[drive]->power_on(now, outgoing_);
  send(drive, now);
}

void HandDevice::power_off() noexcept {
  for (const auto& d : drives_) d->power_off();
}

std::array<std::int16_t, 3> HandDevice::torque_permille() const noexcept {
  const double per_permille = mechanics_.body().drives.torque_Nm(1);
  const auto told = [&](std::size_t i) {
    return static_cast<std::int16_t>(std::lround(drives_[i]->torque_Nm() / per_permille));
  };
  return {told(0), told(1), told(2)};
}

double HandDevice::bus_load() const noexcept {
  const Time span = bus_.last_sync - bus_.first_sync;
  if (span <= Time(0)) return 0.0;
  return static_cast<double>((wire_.stats().busy - bus_.busy_at_first_sync).count()) /
         static_cast<double>(span.count());
}

}  // namespace ligature::sim
