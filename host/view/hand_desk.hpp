#pragma once
#include <array>
#include <chrono>
#include <cstdint>
#include <functional>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "host/messages.hpp"
#include "host/view/access.hpp"
#include "ligature_msg/hand_state_t.hpp"
#include "ligature_msg/hand_wish_t.hpp"

namespace ligature::host::view {

inline constexpr std::string_view kHandWishChannel = "LIGATURE_HAND_WISH";
inline constexpr std::string_view kHandStateChannel = "LIGATURE_HAND_STATE";

/// A state that anybody may have sent: every byte is used, and it is of one of two hands, within a room.
[[nodiscard]] std::optional<ligature_msg::hand_state_t> hand_state_of(Bytes message);

/// Passes on where a page wants a simulated hand. A hand belongs to one page at a time, here and among all views of the
/// rig: the device says who has it (protocol/lcm/hand_wish_t.lcm). Nothing is ever repeated: when a page falls silent,
/// so does this, and the device lets go.
class HandDesk {
 public:
  using Clock = std::chrono::steady_clock;
  using Publish = std::function<void(const ligature_msg::hand_wish_t&)>;
  static constexpr auto kDeafAfter = std::chrono::seconds(1);  // a hand that listens says so 20 times a second

  HandDesk(const Access& access, Publish publish) : access_(access), publish_(std::move(publish)) {}

  /// {"hand": "take" | "leave", "side": "left" | "right", "id": 7, "token": ".."}, which is answered; or
  /// {"wish": {"left": {"p": [x, y, z] in world metres, "dead": true, "grip": false}, "right": ..}, "token": ".."},
  /// which is answered only where the token is wrong. A page wishes for the hands that it has taken.
  [[nodiscard]] nlohmann::json request(std::uint64_t page, const nlohmann::json& message, Clock::time_point now);

  /// The page is gone: what it had is given back, with the dead-man let go.
  void end(std::uint64_t page);

  /// What the rig says; called by the thread that hears LCM.
  void take_status(const ligature_msg::status_t& status);
  void take_state(const ligature_msg::hand_state_t& state, Clock::time_point now);

  /// For all pages: {"left": {"listens": .., "free": .., "page": who has it here or 0, "p_W": where it is, while one
  /// has}, "right": .., "scale": world metres a device metre, 0 while no scene is known}.
  [[nodiscard]] nlohmann::json told(Clock::time_point now) const;

 private:
  struct Hand {
    std::optional<ligature_msg::hand_state_t> state;  // newest
    Clock::time_point heard;
    std::uint64_t page = 0;  // that has it
    std::int64_t session = 0, owner = 0, sequence = 0;
  };
  struct Workspace {
    double scale = 0.0;  // world metres a device metre
    std::array<double, 3> origin_W_m{};
  };

  [[nodiscard]] nlohmann::json place_of(const Hand& hand) const;
  [[nodiscard]] std::string take(Hand& hand, std::uint64_t page, Clock::time_point now);
  void leave(Hand& hand);
  void wish(Hand& hand, const nlohmann::json& wanted);
  [[nodiscard]] ligature_msg::hand_wish_t next_of(Hand& hand);
  void publish_quietly(const ligature_msg::hand_wish_t& wish);
  [[nodiscard]] static bool listens(const Hand& hand, Clock::time_point now);

  const Access& access_;
  Publish publish_;
  mutable std::mutex mutex_;
  std::array<Hand, 2> hands_;
  std::string scene_toml_;
  std::optional<Workspace> workspace_;
};

}  // namespace ligature::host::view
