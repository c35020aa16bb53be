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

/// Decodes the state of a hand; anybody on the network may have sent the message. @return nullopt unless the message is
/// complete, its hand is 0 or 1, and no coordinate of its position is beyond 10 m.
[[nodiscard]] std::optional<ligature_msg::hand_state_t> hand_state_of(Bytes message);

/// Passes on the positions to which a page moves a simulated hand (its "wishes"). A hand belongs to one page at a time.
/// The simulated device decides which page that is, even if the pages belong to several view programs: it obeys the
/// first sender (protocol/lcm/hand_wish_t.lcm). Wishes are never repeated: when the page stops sending, so does this
/// class, and the device lets go.
class HandDesk {
 public:
  using Clock = std::chrono::steady_clock;
  using Publish = std::function<void(const ligature_msg::hand_wish_t&)>;
  static constexpr auto kDeafAfter = std::chrono::seconds(1);  // a hand that has sent no state for so long is absent

  HandDesk(const Access& access, Publish publish) : access_(access), publish_(std::move(publish)) {}

  /// Handles the two messages of a page, which also contain "token": "..":
  /// - {"hand": "take" | "leave", "side": "left" | "right", "id": 7} takes a hand or gives it back. It is always
  ///   answered. A refusal with "soon": true means: the hand is just being given back, try again in a moment.
  /// - {"wish": {"left": {"p": [x, y, z] in world metres, "dead": true, "grip": false}, "right": ..}} moves hands. It
  ///   is answered only when the token is wrong. Wishes for hands that the page has not taken are ignored.
  [[nodiscard]] nlohmann::json request(std::uint64_t page, const nlohmann::json& message, Clock::time_point now);

  /// Call when the connection to a page has ended: gives its hands back, with the dead-man released.
  void end(std::uint64_t page);

  /// Messages of the rig; called on the LCM thread.
  void take_status(const ligature_msg::status_t& status);
  void take_state(const ligature_msg::hand_state_t& state, Clock::time_point now);

  /// The state of both hands, for all pages: {"left": {"listens": .., "free": .., "page": .., "p_W": ..}, "right": ..,
  /// "scale": world metres per device metre, 0 while no scene is known}.
  /// - listens: a simulated device that obeys pages has sent its state within kDeafAfter;
  /// - free: it listens and a page may take it: no page has it, here or at another view program, and none is just
  ///   giving it back;
  /// - page: number of the page that has it; 0: none of this program;
  /// - p_W: its position in world metres, only while a page has it and the scene is known.
  [[nodiscard]] nlohmann::json told(Clock::time_point now) const;

 private:
  struct Hand {
    std::optional<ligature_msg::hand_state_t> state;  // newest received
    Clock::time_point heard;
    std::uint64_t page = 0;                             // page that has the hand; 0: none
    std::int64_t session = 0, owner = 0, sequence = 0;  // of the wishes sent for this page; as in hand_wish_t
    // After a page has given the hand back: number of further states that may still have the old session number,
    // because the device has not handled that yet
    int states_awaited = 0;
  };
  struct Workspace {
    double scale = 0.0;  // world metres per device metre
    std::array<double, 3> origin_W_m{};
  };

  [[nodiscard]] nlohmann::json place_of(const Hand& hand) const;
  [[nodiscard]] std::string take(Hand& hand, std::uint64_t page, Clock::time_point now);
  void leave(Hand& hand);
  void wish(Hand& hand, const nlohmann::json& wanted);
  [[nodiscard]] ligature_msg::hand_wish_t next_of(Hand& hand);
  void publish_quietly(const ligature_msg::hand_wish_t& wish);
  [[nodiscard]] static bool is_being_left(const Hand& hand);
  [[nodiscard]] static bool listens(const Hand& hand, Clock::time_point now);

  const Access& access_;
  Publish publish_;
  mutable std::mutex mutex_;
  std::array<Hand, 2> hands_;
  std::string scene_toml_;
  std::optional<Workspace> workspace_;
};

}  // namespace ligature::host::view
