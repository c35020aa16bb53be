#include "sim_device/shelf_drives.hpp"

#include <algorithm>
#include <numbers>

#include "protocol/can/device_profile.hpp"
#include "protocol/can/remote.hpp"
#include "sim_device/moteus_node.hpp"
#include "sim_device/odrive_node.hpp"
#include "sim_device/power_stage.hpp"
#include "sim_device/profile_node.hpp"

namespace ligature::sim {
namespace {

using std::chrono::milliseconds;
constexpr Time kBoot = milliseconds(300);
constexpr std::uint32_t kElbowNode = 3;

float turns(const Sensed& sensed, std::uint32_t counts) {
  return static_cast<float>(static_cast<double>(sensed.position_counts) / counts);
}
void hand_over(std::deque<can::Frame>& from, std::vector<can::Frame>& out) {
  out.insert(out.end(), from.begin(), from.end());
  from.clear();
}

/// One ODrive, and the button module if it is the elbow's.
class Odrive final : public BusNode {
 public:
  Odrive(std::uint32_t node, std::uint32_t counts_per_revolution, const device::OdriveProfile& profile, Time now)
      : id_(node), counts_(counts_per_revolution), profile_(profile), node_(node, settings_of(profile), now) {}

  void power_on(Time now, std::vector<can::Frame>& out) override {
    node_.power_cycle(now, off_ ? kBoot : Time(0));
    off_ = false;
    poll(now, {}, out);
  }
  void power_off() noexcept override {
    off_ = true;
    node_.power_cycle(Time(0), kNever);
  }
  void on_frame(const can::Frame& frame, Time now, const Sensed& sensed, std::vector<can::Frame>& out) override {
    if (off_) return;
    node_.position_rev = turns(sensed, counts_);
    node_.take(frame, now);
    hand_over(node_.out, out);
    if (id_ == kElbowNode && frame.id == (can::kRemoteBit | (id_ << 5U | kEstimates)))
      out.push_back({profile_.buttons_id, 2, {static_cast<std::uint8_t>(sensed.buttons), ++life_}});
  }
  void poll(Time now, const Sensed&, std::vector<can::Frame>& out) override {
    if (off_) return;
    node_.advance(now);
    hand_over(node_.out, out);
  }
  Time next_deadline() const noexcept override { return off_ ? kNever : node_.next_deadline(); }
  Meaning meaning_of(const can::Frame& frame) const noexcept override {
    constexpr std::uint32_t kFirstRequest = can::kRemoteBit | (1U << 5U | kEstimates);
    if (frame.id == kFirstRequest) return Meaning::kPeriod;
    return !can::is_remote(frame) && (frame.id & 0x1FU) == kTorque ? Meaning::kTorque : Meaning::kState;
  }
  double torque_Nm() const noexcept override {
    const double most_Nm = profile_.torque_constant_Nm_per_A * static_cast<double>(node_.current_limit_A());
    return std::clamp(static_cast<double>(node_.torque_Nm()), -most_Nm, most_Nm);
  }
  bool is_enabled() const noexcept override { return node_.is_on(); }
  bool has_fault() const noexcept override { return node_.has_error(); }
  DriveStats stats() const noexcept override { return {.watchdog_trips = node_.watchdog_trips}; }
  int trial_periods() const noexcept override { return 3 * profile_.watchdog_ms + 20 * profile_.heartbeat_ms; }
  void fail() noexcept { node_.fail(); }

 private:
  static constexpr std::uint32_t kEstimates = 0x09, kTorque = 0x0E;

  static OdriveSettings settings_of(const device::OdriveProfile& p) {
    OdriveSettings settings;
    settings.watchdog = p.watchdog == device::DriveWatchdog::kNone ? Time(0) : milliseconds(p.watchdog_ms);
    settings.heartbeat = milliseconds(p.heartbeat_ms);
    return settings;
  }

  std::uint32_t id_, counts_;
  device::OdriveProfile profile_;
  OdriveNode node_;
  std::uint8_t life_ = 0;
  bool off_ = false;
};

/// One moteus controller, and the button module if it is the elbow's.
class Moteus final : public BusNode {
 public:
  Moteus(std::uint32_t node, std::uint32_t counts_per_revolution)
      : id_(node), counts_(counts_per_revolution), node_(node, {}) {}

  void power_on(Time now, std::vector<can::Frame>&) override {
    node_.power_cycle(now, off_ ? kBoot : Time(0));
    off_ = false;
  }
  void power_off() noexcept override {
    off_ = true;
    node_.power_cycle(Time(0), kNever);
  }
  void on_frame(const can::Frame& frame, Time now, const Sensed& sensed, std::vector<can::Frame>& out) override {
    if (off_) return;
    look(now, sensed);
    node_.take(frame, now);
    hand_over(node_.out, out);
    constexpr std::size_t kAskedRegister = 9;  // byte of the request
    if (frame.id == (can::kExtendedBit | kReplies | kElbowNode) && id_ == kElbowNode)
      out.push_back({kButtonsId, 2, {static_cast<std::uint8_t>(sensed.buttons), frame.data[kAskedRegister]}});
  }
  void poll(Time now, const Sensed& sensed, std::vector<can::Frame>& out) override {
    if (off_) return;
    look(now, sensed);
    node_.advance(now);
    hand_over(node_.out, out);
  }
  /// After its watchdog a moteus damps the motion, so its torque follows the speed. 1 ms is often enough: the damping
  /// stops a joint in about 0.1 s.
  Time next_deadline() const noexcept override {
    const Time at = off_ ? kNever : node_.next_deadline();
    return !off_ && node_.mode() == kTimeoutMode ? std::min(at, looked_ + milliseconds(1)) : at;
  }
  Meaning meaning_of(const can::Frame& frame) const noexcept override {
    if (frame.id == (can::kExtendedBit | kReplies | 1U)) return Meaning::kPeriod;
    return (frame.id & kReplies) != 0 ? Meaning::kState : Meaning::kTorque;
  }
  double torque_Nm() const noexcept override { return static_cast<double>(node_.torque_Nm()); }
  bool is_enabled() const noexcept override { return node_.mode() == kPositionMode; }
  bool has_fault() const noexcept override { return node_.has_fault() || node_.mode() == kTimeoutMode; }
  DriveStats stats() const noexcept override { return {.watchdog_trips = node_.watchdog_trips}; }
  int trial_periods() const noexcept override { return 300; }
  void fail() noexcept { node_.fail(kOfMotorDriver); }

 private:
  static constexpr std::uint32_t kReplies = 0x8000, kButtonsId = 0x400;
  static constexpr int kPositionMode = 10, kTimeoutMode = 11, kOfMotorDriver = 33;

  void look(Time now, const Sensed& sensed) noexcept {
    looked_ = now;
    node_.position_rev = turns(sensed, counts_);
    node_.velocity_rev_per_s = static_cast<float>(sensed.velocity_rad_per_s / (2.0 * std::numbers::pi));
  }

  std::uint32_t id_, counts_;
  MoteusNode node_;
  Time looked_{0};
  bool off_ = false;
};

}  // namespace

void fail_power_stage(BusNode& drive) {
  if (auto* moteus = dynamic_cast<Moteus*>(&drive)) return moteus->fail();
  dynamic_cast<Odrive&>(drive).fail();
}

BusNodes drives_of(const device::Device& device, const DriveConstants& constants, Time now) {
  BusNodes drives;
  const std::uint32_t counts = constants.counts_per_revolution;
  for (std::uint32_t i = 0; i < drives.size(); ++i) {
    if (device.odrive)
      drives[i] = std::make_unique<Odrive>(i + 1, counts, *device.odrive, now);
    else if (device.moteus)
      drives[i] = std::make_unique<Moteus>(i + 1, counts);
    else
      drives[i] = std::make_unique<ProfileNode>(can::profile::kJointNodes[i], device, constants);
  }
  return drives;
}

}  // namespace ligature::sim
