#pragma once
// Cyclic traffic of one hand with ODrive drives: remote frames out, estimates and buttons in, torques out. A torque
// acts when it arrives; there is no SYNC.

#include <algorithm>
#include <array>
#include <cstdint>

#include "firmware/platform/answer_set.hpp"
#include "firmware/platform/link_bus.hpp"
#include "firmware/platform/odrive_frames.hpp"
#include "protocol/device/device.hpp"

namespace ligature::platform {

/// Real time: every call is bounded, does not allocate, and makes only the bus's system calls.
class OdriveLink {
 public:
  OdriveLink(CanBus& bus, const device::Device& device) noexcept;

  /// Begins a period: first reads late answers of the last period (as one period old), then asks all drives (see
  /// AnswerSet). It asks nobody while drives that must be off have not said so.
  void request() noexcept;
  void drain() noexcept;
  [[nodiscard]] bool is_settled() const noexcept { return answers_.age_ticks() == 0 || bus_.is_lost(); }
  [[nodiscard]] rt::HandReading reading() const noexcept;
  std::array<std::int16_t, rt::kJoints> write(const rt::HandCommand& command) noexcept;

  // For start-up.
  struct Node {
    odrive::Heartbeat heartbeat;
    int beats = 0;                   ///< heartbeats since forget_beats(), up to a large number
    int silent = 0;                  ///< periods since the last one
    bool had_error = false;          ///< in a heartbeat since the last write()
    bool was_off = false;            ///< likewise
    bool answers = false;            ///< it has sent its position when asked
    bool tells_unasked = false;      ///< it has sent its position more often; in operation since the last write()
    bool was_away = false;           ///< it was silent for too long: it may have started anew, untested
    bool is_new = false;             ///< its software is supported
    std::optional<float> target_Nm;  ///< the torque that it aims at, as told since forget_targets()
    [[nodiscard]] bool is_on() const noexcept { return heartbeat.state == odrive::kClosedLoop; }
  };
  [[nodiscard]] const std::array<Node, rt::kJoints>& nodes() const noexcept { return nodes_; }
  void forget_beats() noexcept;
  void forget_targets() noexcept;
  [[nodiscard]] bool has_samples() const noexcept { return answers_.is_valid(); }
  [[nodiscard]] rt::Foreign foreign() const noexcept { return foreign_; }
  /// Whether a drive's heartbeat has stayed away. The drives then stay off until the controller is started again.
  [[nodiscard]] bool was_away() const noexcept {
    return std::ranges::any_of(nodes_, [](const Node& node) { return node.was_away; });
  }
  /// Whether the bus has refused a frame since the start.
  [[nodiscard]] bool has_refused() const noexcept { return has_refused_; }
  bool send(const can::Frame& frame) noexcept;
  bool send_limits(std::size_t joint) noexcept;

 private:
  static constexpr int kNear = 10;        // periods after a frame of another controller, which may send more
  static constexpr int kMargin = 3;       // periods of a silence beyond the longest watchdog that start-up accepts
  static constexpr int kMissedBeats = 3;  // heartbeats of a drive that may be missing in a row

  void take(const can::Frame& frame) noexcept;
  void take_beat(Node& node, const can::Frame& frame) noexcept;
  void take_buttons(const can::Frame& frame) noexcept;
  [[nodiscard]] bool said_off(const Node& node) const noexcept;
  void take_part(std::size_t part) noexcept;
  void ask_all() noexcept;
  void switch_off(bool stops) noexcept;
  void bring_up() noexcept;
  [[nodiscard]] std::int16_t permille_of(double torque_Nm) const noexcept;

  LinkBus bus_;
  double Nm_per_permille_;
  std::int32_t max_permille_;
  device::OdriveProfile profile_;
  float most_current_A_;
  std::array<Node, rt::kJoints> nodes_{};
  std::array<float, rt::kJoints> pending_rev_{}, rev_{};
  AnswerSet answers_;
  ButtonModule buttons_;
  bool has_refused_ = false;
  rt::Foreign foreign_ = rt::Foreign::kNone;
  int off_periods_ = 0;       // in a row, in which the drives should be off
  int silent_periods_ = 0;    // that are left of a silence in which the watchdog of a drive that does not obey runs out
  int foreign_periods_ = 0;   // in which a frame of another controller still counts as near
  bool may_ask_ = true;       // the drives may be on, or all have said that they are off
  int up_periods_ = 0;        // since the last round of commands to switch drives on
  bool is_prepared_ = false;  // the bus has taken this drive's mode and limits
};

}  // namespace ligature::platform
