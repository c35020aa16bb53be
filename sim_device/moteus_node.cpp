#include "sim_device/moteus_node.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace ligature::sim {
namespace {

constexpr int kStopped = 0, kFault = 1, kEnabling = 2, kPosition = 10, kTimeout = 11;

/// Reads the sub-frames of a frame.
class Bytes {
 public:
  explicit Bytes(const can::Frame& f) : frame_(f) {}
  [[nodiscard]] bool more() const { return at_ < frame_.dlc; }
  std::uint8_t byte() { return more() ? frame_.data[at_++] : std::uint8_t{0x50}; }
  float number(unsigned kind, std::uint32_t reg) {  // 0: 8 bits, 3: a float; the controller sends no others
    if (kind == 0) {
      const auto small = static_cast<std::int8_t>(byte());
      if (small == -128) return std::numeric_limits<float>::quiet_NaN();
      return static_cast<float>(small) * (reg == 0x23 || reg == 0x24 || reg == 0x2B ? 1.0F / 127.0F : 1.0F);
    }
    std::uint32_t bits = 0;
    for (unsigned i = 0; i < 4; ++i) bits |= static_cast<std::uint32_t>(byte()) << (8U * i);
    return std::bit_cast<float>(bits);
  }

 private:
  const can::Frame& frame_;
  std::size_t at_ = 0;
};

}  // namespace

MoteusNode::MoteusNode(std::uint32_t node, const MoteusSettings& s) : settings(s), node_(node), mode_(s.starts_in) {}

void MoteusNode::power_cycle(Time now, Time boot) {
  const float stays_rev = position_rev;
  *this = MoteusNode(node_, settings);
  position_rev = stays_rev;
  powered_.arm(now + boot);
}

void MoteusNode::fail(int fault) {
  mode_ = kFault;
  fault_ = fault;
}

float MoteusNode::torque_Nm() const noexcept {
  constexpr float kGain_Nm_per_rev = 4.0F, kFixed_Nm = 0.05F;
  if (mode_ >= 5 && mode_ <= 9) return kFixed_Nm;
  if (mode_ == kTimeout)
    return std::clamp(-settings.damping_Nm_s_per_rev * velocity_rev_per_s, -settings.damping_most_Nm,
                      settings.damping_most_Nm);
  if (mode_ != kPosition) return 0.0F;
  const float aside = std::isnan(command_.position) ? 0.0F : command_.position - position_rev;
  const float wanted = command_.torque + adds_Nm + command_.kp * kGain_Nm_per_rev * aside;
  return std::isnan(command_.most_torque) ? wanted : std::clamp(wanted, -command_.most_torque, command_.most_torque);
}

void MoteusNode::advance(Time now) {
  if (powered_.is_over(now)) powered_.disarm();
  if (ready_.is_over(now)) {
    ready_.disarm();
    mode_ = kPosition;
    if (settings.fault_when_on != 0) fail(settings.fault_when_on);
  }
  if (watchdog_.is_over(now)) {
    watchdog_.disarm();
    ++watchdog_trips;
    if (mode_ == kPosition) mode_ = kTimeout;
  }
  while (!late_.empty() && late_.front().first <= now) {
    out.push_back(late_.front().second);
    late_.pop_front();
  }
}

Time MoteusNode::next_deadline() const noexcept {
  return std::min({powered_.at(), ready_.at(), watchdog_.at(), late_.empty() ? kNever : late_.front().first});
}

float* MoteusNode::setting(std::uint32_t reg) noexcept {
  switch (reg) {
    case 0x20:
      return &command_.position;
    case 0x22:
      return &command_.torque;
    case 0x23:
      return &command_.kp;
    case 0x24:
      return &command_.kd;
    case 0x25:
      return &command_.most_torque;
    case 0x27:
      return &command_.watchdog_s;
    case 0x2B:
      return &command_.ilimit;
    default:
      return nullptr;
  }
}

float MoteusNode::value(std::uint32_t reg) noexcept {
  if (const float* f = setting(reg)) return *f;
  switch (reg) {
    case 0x00:
      return static_cast<float>(mode_);
    case 0x01:
      return position_rev;
    case 0x03:
      return torque_Nm();
    case 0x0C:
      return static_cast<float>(settings.home);
    case 0x0F:
      return static_cast<float>(mode_ == kFault ? fault_ : mode_ == kPosition ? limit : 0);
    default:
      return 0.0F;
  }
}

void MoteusNode::take(const can::Frame& frame, Time now) {
  advance(now);
  if (powered_.at() != kNever || (frame.id & 0x7FU) != node_ || frame.format == can::Format::kClassic) return;
  can::Frame reply{node_ << 8U, 0, {}, can::Format::kFdFast};
  const auto tell = [&reply](std::uint8_t b) { reply.data[reply.dlc++] = b; };
  bool has_command = false;
  for (Bytes bytes(frame); bytes.more();) {
    const unsigned head = bytes.byte();
    if (head == 0x50) continue;
    const unsigned kind = head >> 2U & 3U, count = head & 3U;
    const std::uint32_t first = bytes.byte();
    for (std::uint32_t reg = first; reg < first + count; ++reg) {
      if (head < 0x10) {
        const float value = bytes.number(kind, reg);
        if (reg == 0x00 && obeys) {
          command_ = {};
          command_.mode = static_cast<int>(value);
          has_command = true;
        } else if (float* f = setting(reg); f != nullptr && obeys && (settings.takes_gains || reg != 0x23)) {
          *f = value;
        }
        continue;
      }
      if (reg == first) {
        tell(static_cast<std::uint8_t>(0x20U | (head & 0x0FU)));
        tell(static_cast<std::uint8_t>(reg));
      }
      const auto bits = std::bit_cast<std::uint32_t>(value(reg));
      if (kind == 0) tell(static_cast<std::uint8_t>(static_cast<std::int8_t>(value(reg))));
      for (unsigned i = 0; kind == 3 && i < 4; ++i) tell(static_cast<std::uint8_t>(bits >> (8U * i)));
    }
  }
  if (has_command) obey(now);
  if ((frame.id & 0x8000U) == 0 || !answers) return;
  for (const std::uint8_t length = can::fd_length(reply.dlc); reply.dlc < length;) tell(0x50);
  late_.emplace_back(now + settings.answers_after, reply);
  advance(now);
}

void MoteusNode::obey(Time now) {
  if (command_.mode == kStopped) {
    if (!settings.obeys_stop) return;
    mode_ = kStopped;
    fault_ = 0;
    watchdog_.disarm();
    ready_.disarm();
    return;
  }
  if (command_.mode != kPosition) return;
  if (mode_ == kStopped) {
    mode_ = kEnabling;
    ready_.arm(now + settings.prepares);
  } else if (mode_ >= 5 && mode_ <= 9) {
    mode_ = kPosition;
  }
  if (settings.has_watchdog && !std::isnan(command_.watchdog_s))
    watchdog_.arm(now + Time(static_cast<std::int64_t>(std::lround(command_.watchdog_s * 1e9F))));
}

}  // namespace ligature::sim
