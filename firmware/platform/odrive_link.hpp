#pragma once
// Cyclic traffic of one hand with ODrive drives: remote frames out, estimates in, torques out. A torque acts when it
// arrives; there is no SYNC.

#include <array>
#include <cstdint>

#include "firmware/platform/can_bus.hpp"
#include "firmware/platform/odrive_frames.hpp"
#include "protocol/device/device.hpp"

namespace ligature::platform {

/// Real time: every call is bounded, does not allocate, and makes only the bus's system calls.
class OdriveLink {
 public:
  OdriveLink(CanBus& bus, const device::Device& device) noexcept;

  /// Begins a period: first reads late frames of the last period, then asks every drive for its position.
  void request() noexcept;
  void drain() noexcept;
  [[nodiscard]] bool is_settled() const noexcept { return age_ticks_ == 0 || bus_.is_lost(); }
  [[nodiscard]] rt::HandReading reading() const noexcept;
  std::array<std::int16_t, rt::kJoints> write(const rt::HandCommand& command) noexcept;

  // For start-up.
  struct Node {
    float position_rev = 0.0F;
    odrive::Heartbeat heartbeat;
    int beats = 0;   ///< heartbeats heard, up to a large number
    int silent = 0;  ///< periods since the last one
    [[nodiscard]] bool is_on() const noexcept { return heartbeat.state == odrive::kClosedLoop; }
  };
  [[nodiscard]] const std::array<Node, rt::kJoints>& nodes() const noexcept { return nodes_; }
  /// Joints that have answered the last request, one bit each.
  [[nodiscard]] unsigned arrived() const noexcept { return arrived_; }
  [[nodiscard]] bool has_buttons() const noexcept { return buttons_age_ <= kOldButtons; }
  [[nodiscard]] rt::Foreign foreign() const noexcept { return foreign_; }
  bool send(const can::Frame& frame) noexcept;

 private:
  static constexpr int kMaxFrames = 64;    // read per call; a period on a 1 Mbit/s bus has fewer than 22
  static constexpr int kOldButtons = 5;    // periods after which the buttons' last frame is no sample any more
  static constexpr int kStillFrames = 10;  // frames of the buttons without a change of their counter
  static constexpr int kMissedBeats = 5;   // heartbeats of a drive that may be missing in a row

  void take(const can::Frame& frame) noexcept;
  void take_buttons(const can::Frame& frame) noexcept;
  void take_set() noexcept;
  void switch_off(bool stops) noexcept;
  void bring_up(std::size_t joint) noexcept;
  [[nodiscard]] std::int16_t permille_of(double torque_Nm) const noexcept;

  CanBus& bus_;
  double rad_per_rev_, Nm_per_permille_, motor_Nm_per_permille_;
  std::int32_t max_permille_;
  int heartbeat_periods_;
  std::uint32_t buttons_id_;
  std::array<Node, rt::kJoints> nodes_{};
  std::array<float, rt::kJoints> pending_rev_{}, rev_{};
  unsigned arrived_ = 0;
  bool valid_ = false, was_lost_ = false, has_life_ = false;
  rt::Foreign foreign_ = rt::Foreign::kNone;
  std::uint16_t buttons_ = 0, pending_buttons_ = 0;
  int buttons_age_ = kOldButtons + 1, still_frames_ = 0;
  int off_periods_ = 0;  // in a row, in which the drives should be off
  int up_periods_ = 0;   // since the last command to bring a drive up
  std::int32_t age_ticks_ = 1;
  unsigned bits_ = 0, bits_of_last_period_ = 0;
};

}  // namespace ligature::platform
