#pragma once
// Cyclic traffic of one hand with moteus drives: queries out, answers and buttons in, torques out. A torque acts when
// it arrives; there is no SYNC.

#include <array>
#include <cstdint>
#include <optional>

#include "firmware/platform/answer_set.hpp"
#include "firmware/platform/link_bus.hpp"
#include "firmware/platform/moteus_frames.hpp"
#include "protocol/device/device.hpp"

namespace ligature::platform {

/// Real time: every call is bounded, does not allocate, and makes only the bus's system calls.
class MoteusLink {
 public:
  MoteusLink(CanBus& bus, const device::Device& device, int watchdog_ms) noexcept;

  /// Begins a period: first reads late answers of the last period (as one period old), then asks all drives.
  void request() noexcept;
  void drain() noexcept;
  [[nodiscard]] bool is_settled() const noexcept { return answers_.age_ticks() == 0 || bus_.is_lost(); }
  [[nodiscard]] rt::HandReading reading() const noexcept;
  /// Drives that shall be off are told so in each period, also after they have said it.
  std::array<std::int16_t, rt::kJoints> write(const rt::HandCommand& command) noexcept;

  static constexpr unsigned kConfirmed = (1U << moteus::kExtras) - 1U;
  struct Node {
    std::optional<moteus::Reply> last;  ///< the newest answer
    std::optional<float> home;          ///< what the drive knows of its position, as it said at first
    unsigned confirmed = 0;             ///< settings of the command that it has told back since it was switched on
    bool is_told_off = false;           ///< the bus has taken the last stop, and nothing else since
    bool is_off = false;                ///< it has said so when asked after the stop
    bool was_on = false;                ///< it has said so since it was switched on
    bool has_failed = false;            ///< it is not in the mode, or has not the settings, that it was commanded
    bool is_lost = false;               ///< it no longer knows its position as at first: until a restart
    bool tells_unasked = false;         ///< more answers than requests since the last write()
    bool asked_when_off = false, asked_when_on = false;  ///< the last query came after the stop, or the torque
    [[nodiscard]] bool is_on() const noexcept { return was_on && !has_failed && confirmed == kConfirmed; }
    [[nodiscard]] std::uint32_t error() const noexcept {
      return last && !moteus::is_limit(last->fault) ? static_cast<std::uint32_t>(last->fault) : 0;
    }
  };
  [[nodiscard]] const std::array<Node, rt::kJoints>& nodes() const noexcept { return nodes_; }
  void forget_off() noexcept;  ///< the drives have to say again that they are off
  [[nodiscard]] rt::Foreign foreign() const noexcept { return foreign_; }
  [[nodiscard]] bool is_on() const noexcept;  ///< all drives are on, with the settings that they were commanded

 private:
  static constexpr int kPatience = 500;  // periods until a drive is on
  static constexpr int kPause = 50;      // periods until the next trial
  enum class Phase : std::uint8_t { kOff, kSwitching, kOn };

  bool send(const can::Frame& frame) noexcept;
  void take(const can::Frame& frame) noexcept;
  void take_reply(std::size_t joint, const can::Frame& frame) noexcept;
  void judge(Node& node, const moteus::Reply& reply) const noexcept;
  void compare(Node& node, const moteus::Reply& reply) const noexcept;
  void take_part(std::size_t part) noexcept;
  [[nodiscard]] bool may_switch_on() const noexcept;
  void switch_off() noexcept;
  void begin_switching() noexcept;
  [[nodiscard]] std::int16_t permille_of(double torque_Nm) const noexcept;

  LinkBus bus_;
  double Nm_per_permille_;
  std::int32_t max_permille_;
  moteus::Limits limits_;
  std::array<Node, rt::kJoints> nodes_{};
  std::array<moteus::Reply, rt::kJoints> pending_{}, used_{};
  moteus::Extra asked_{};  // the extra register of the last request: an answer to another one is late
  AnswerSet answers_{static_cast<int>(moteus::kExtras)};
  ButtonModule buttons_;
  rt::Foreign foreign_ = rt::Foreign::kNone;
  Phase phase_ = Phase::kOff;
  int switching_periods_ = 0, pause_periods_ = 0;
};

}  // namespace ligature::platform
