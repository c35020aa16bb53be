#include "bridge/drives.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace ligature::bridge {
namespace {

sim::DriveConstants constants_of(const device::Device& record) {
  return {static_cast<std::uint32_t>(std::lround(record.counts_per_revolution())),
          static_cast<std::uint32_t>(std::lround(record.rated_torque_Nm * 1e3)), record.max_torque_permille};
}

bool is_sample(const can::Frame& frame) {
  const auto address = can::address_of(frame.id);
  return address && address->service == can::Service::kTpdo1;
}

}  // namespace

std::string objection_to(const device::Device& record, Time exchange) {
  if (record.kinematics != device::Kinematics::kCartesian)
    return "device " + record.name + ": found joints, allowed kinematics = \"cartesian\": the device tells a position";
  if (Drives::oldest_sample(record) > exchange) return {};
  std::ostringstream text;
  text << "device " << record.name << ": drives.delay_s: found " << record.delay_s
       << ", allowed more than a period and an exchange with the device, "
       << std::chrono::duration<double>(sim::HandDevice::kPeriod + exchange).count()
       << "; remedy: a higher --rate, or the delay that you have measured (docs/bridge.md)";
  return text.str();
}

Time Drives::oldest_sample(const device::Device& record) {
  return std::chrono::duration_cast<Time>(std::chrono::duration<double>(record.delay_s)) - sim::HandDevice::kPeriod;
}

Drives::Drives(const device::Device& record, Time now, Time silence, bool charge_bus_time)
    : linkage_(record),
      constants_(constants_of(record)),
      silence_(silence),
      oldest_(oldest_sample(record)),
      now_(now),
      wire_(charge_bus_time),
      nodes_{sim::DriveNode(can::kWaist, constants_), sim::DriveNode(can::kShoulder, constants_),
             sim::DriveNode(can::kElbow, constants_)} {}

void Drives::take(const DeviceState& state, Time at) noexcept {
  state_ = state;
  heard_at_ = at;
}

void Drives::advance(Time now) {
  while (const auto heard = wire_.advance(now)) hear(*heard);
  poll(now);
}

void Drives::hear(const sim::Transmission& heard) {
  poll(heard.end);
  const bool keeps_silent = can::is_sync(heard.frame) && !answers(heard.end);
  for (std::size_t i = 0; is_on_ && i < nodes_.size(); ++i) {
    if (static_cast<int>(i) == heard.sender) continue;
    nodes_[i].on_frame(heard.frame, heard.end, sensed(i), outgoing_);
    if (keeps_silent) std::erase_if(outgoing_, is_sample);
    send(i, heard.end);
  }
  deliveries_.push_back({heard.frame, heard.sender, heard.end});
}

/// Whether the newest state is recent enough to answer a SYNC at this time. Also updates the counters in ages_.
bool Drives::answers(Time at) noexcept {
  ++ages_.syncs;
  const Time age = is_on_ && heard_at_ ? at - *heard_at_ : Time::max();
  if (age > oldest_) {
    ++ages_.stale;
    ages_.silent += is_on_ ? 0 : 1;
    return false;
  }
  ages_.sum += age;
  ages_.worst = std::max(ages_.worst, age);
  return true;
}

sim::Sensed Drives::sensed(std::size_t drive) const noexcept {
  const sim::Vec3 p(state_.p_D_m.data());
  const auto q = linkage_.joints(p);  // a Cartesian linkage reaches every position
  const bool stylus = can::profile::has_stylus_buttons(nodes_[drive].id());
  return {constants_.counts_of(q.value()[static_cast<Eigen::Index>(drive)]),
          stylus ? state_.buttons : std::uint16_t{0}};
}

void Drives::poll(Time now) {
  now_ = std::max(now_, now);
  watch(now_);
  for (std::size_t i = 0; is_on_ && i < nodes_.size(); ++i) {
    const Time due = nodes_[i].next_deadline();
    if (due > now_) continue;
    nodes_[i].poll(now_, {}, outgoing_);
    send(i, due);
  }
}

/// Switches the drives off when the device has become silent, and on when it sends states again.
void Drives::watch(Time now) {
  const bool is_heard = heard_at_ && now - *heard_at_ <= silence_;
  if (is_heard == is_on_) return;
  is_on_ = is_heard;
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    nodes_[i].power_off();
    if (!is_on_) {
      wire_.drop(static_cast<int>(i));
      continue;
    }
    nodes_[i].power_on(now, outgoing_);
    send(i, now);
  }
}

void Drives::send(std::size_t drive, Time now) {
  for (const can::Frame& f : outgoing_) wire_.submit(f, static_cast<int>(drive), now);
  outgoing_.clear();
}

Time Drives::wake_at() const noexcept {
  Time at = wire_.quiet_at();
  if (!deliveries_.empty()) at = std::min(at, deliveries_.front().due);
  if (!is_on_ || !heard_at_) return at;
  for (const sim::DriveNode& node : nodes_) at = std::min(at, node.next_deadline());
  return std::min(at, *heard_at_ + silence_ + Time(1));
}

Vec Drives::force_D_N() const noexcept {
  sim::Vec3 torque_Nm = sim::Vec3::Zero();
  for (std::size_t i = 0; is_on_ && i < nodes_.size(); ++i)
    torque_Nm[static_cast<Eigen::Index>(i)] = constants_.torque_Nm(nodes_[i].torque_permille());
  // torque = J^T force, and J of a Cartesian linkage is diagonal and constant
  const sim::Vec3 force = torque_Nm.cwiseQuotient(linkage_.jacobian_D(sim::Vec3::Zero()).diagonal());
  return {force[0], force[1], force[2]};
}

}  // namespace ligature::bridge
