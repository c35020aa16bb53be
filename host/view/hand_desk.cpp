#include "host/view/hand_desk.hpp"

#include <algorithm>
#include <cmath>

#include "host/view/json_text.hpp"
#include "host/wall_clock.hpp"
#include "protocol/lcm/fresh_id.hpp"
#include "protocol/scene/recorded_scene.hpp"

// NOLINTBEGIN(bugprone-unchecked-optional-access): a hand that listens has a state, and callers ask that first

namespace ligature::host::view {
namespace {

using ligature_msg::hand_wish_t;
using nlohmann::json;

constexpr std::array<const char*, 2> kSides{"left", "right"};
constexpr int kStatesAfterLeaving = 3;  // after these a device that still has the old session has lost the message
constexpr double kFarthest_m = 10.0;    // limit on coordinates in the device's frame, m; larger than any room

json answer(const json& message, bool accepted, const std::string& text) {
  const std::string word = text_of(message, "hand").substr(0, 10) + " " + text_of(message, "side").substr(0, 10);
  return {{"id", id_of(message)}, {"command", word}, {"accepted", accepted}, {"text", text}};
}

std::optional<std::array<double, 3>> point_of(const json& wanted) {
  const auto p = wanted.find("p");
  if (p == wanted.end() || !p->is_array() || p->size() != 3) return std::nullopt;
  if (!std::ranges::all_of(*p, [](const json& x) { return x.is_number(); })) return std::nullopt;
  return p->get<std::array<double, 3>>();
}

bool flag_of(const json& wanted, const char* key) {
  const auto found = wanted.find(key);
  return found != wanted.end() && found->is_boolean() && found->get<bool>();
}

}  // namespace

std::optional<ligature_msg::hand_state_t> hand_state_of(Bytes message) {
  ligature_msg::hand_state_t state{};
  const int size = state.getEncodedSize();
  if (message.size() != static_cast<std::size_t>(size) || state.decode(message.data(), 0, size) != size)
    return std::nullopt;
  const bool is_within = std::ranges::all_of(state.p_home_m, [](double x) { return std::abs(x) <= kFarthest_m; });
  return (state.hand == 0 || state.hand == 1) && is_within ? std::optional(state) : std::nullopt;
}

json HandDesk::request(std::uint64_t page, const json& message, Clock::time_point now) {
  if (const auto why = objection_to(text_of(message, "token"), access_); !why.empty())
    return answer(message, false, why);
  const std::scoped_lock lock(mutex_);
  if (const auto wishes = message.find("wish"); wishes != message.end()) {
    for (std::size_t i = 0; i < kSides.size(); ++i) {
      if (!wishes->is_object() || hands_[i].page != page) continue;
      if (const auto wanted = wishes->find(kSides[i]); wanted != wishes->end()) wish(hands_[i], *wanted);
    }
    return nullptr;
  }
  const auto side = std::ranges::find(kSides, text_of(message, "side"));
  if (side == kSides.end()) return answer(message, false, "side: allowed left, right");
  Hand& hand = hands_[static_cast<std::size_t>(side - kSides.begin())];
  const std::string word = text_of(message, "hand");
  if (word == "leave") {
    if (hand.page != page) return answer(message, false, "this page does not have that hand");
    leave(hand);
    return answer(message, true, "");
  }
  if (word != "take") return answer(message, false, "hand: allowed take, leave");
  if (const auto why = take(hand, page, now); !why.empty()) {
    json refusal = answer(message, false, why);
    refusal["soon"] = is_being_left(hand);
    return refusal;
  }
  json done = answer(message, true, "");
  done["p_W"] = place_of(hand);
  done["grip"] = hand.state->grip != 0;
  done["page"] = page;
  return done;
}

/// Position of a hand in world coordinates, m.
/// @pre the hand has a state and the workspace is known.
json HandDesk::place_of(const Hand& hand) const {
  json p_W = json::array();
  for (std::size_t axis = 0; axis < 3; ++axis)
    p_W.push_back(workspace_->origin_W_m[axis] + workspace_->scale * hand.state->p_home_m[axis]);
  return p_W;
}

/// Gives the hand to a page. @return the reason for a refusal; empty on success.
std::string HandDesk::take(Hand& hand, std::uint64_t page, Clock::time_point now) {
  const std::string side = kSides[static_cast<std::size_t>(&hand - hands_.data())];
  if (!listens(hand, now))
    return "no simulated hand listens: start ligature-device --hand " + side +
           " --operator page; a real device is moved by its own hand alone";
  if (!workspace_) return "no scene is known yet: is ligature-firmware running?";
  if (hand.page == page) return {};
  if (is_being_left(hand)) return "the " + side + " hand is just being given back";
  if (hand.page != 0 || hand.state->owner != 0) return "somebody else has the " + side + " hand";
  hand.page = page;
  hand.session = hand.state->session;
  hand.owner = lcm_tools::fresh_id();
  hand.sequence = 0;
  auto first = next_of(hand);  // the present position, so that the device is taken without moving
  first.grip = hand.state->grip;
  std::ranges::copy(hand.state->p_home_m, first.p_home_m);
  publish_quietly(first);
  return {};
}

void HandDesk::leave(Hand& hand) {
  auto last = next_of(hand);
  last.leaves = 1;
  last.grip = hand.state->grip;
  std::ranges::copy(hand.state->p_home_m, last.p_home_m);
  publish_quietly(last);
  hand.page = 0;
  hand.states_awaited = kStatesAfterLeaving;
}

void HandDesk::wish(Hand& hand, const json& wanted) {
  const auto p_W = wanted.is_object() ? point_of(wanted) : std::nullopt;
  if (!p_W || !workspace_) return;
  auto message = next_of(hand);
  message.dead_man = flag_of(wanted, "dead") ? 1 : 0;
  message.grip = flag_of(wanted, "grip") ? 1 : 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double p_home_m = ((*p_W)[axis] - workspace_->origin_W_m[axis]) / workspace_->scale;
    if (!std::isfinite(p_home_m)) return;
    message.p_home_m[axis] = std::clamp(p_home_m, -kFarthest_m, kFarthest_m);
  }
  publish_quietly(message);
}

hand_wish_t HandDesk::next_of(Hand& hand) {
  hand_wish_t wish{};
  wish.utime = now_us();
  wish.session = hand.session;
  wish.owner = hand.owner;
  wish.sequence = ++hand.sequence;
  wish.hand = static_cast<std::int8_t>(&hand - hands_.data());
  return wish;
}

/// Ignores failures to send: a device that receives nothing lets go.
void HandDesk::publish_quietly(const hand_wish_t& wish) {
  try {
    publish_(wish);
  } catch (const std::exception&) {
    return;
  }
}

void HandDesk::end(std::uint64_t page) {
  const std::scoped_lock lock(mutex_);
  for (Hand& hand : hands_)
    if (hand.page == page) leave(hand);
}

void HandDesk::take_status(const ligature_msg::status_t& status) {
  const std::scoped_lock lock(mutex_);
  if (status.scene_toml == scene_toml_) return;
  scene_toml_ = status.scene_toml;
  const auto read = scene::parse_recorded(status.scene_toml, status.scene_file);
  workspace_.reset();
  if (const auto* scene = std::get_if<scene::Scene>(&read))
    workspace_ = Workspace{scene->hands.workspace_scale, scene->hands.workspace_origin_m};
}

/// The device's state names the owner of the hand. States that were sent before this page's first wish name no owner
/// yet.
void HandDesk::take_state(const ligature_msg::hand_state_t& state, Clock::time_point now) {
  const std::scoped_lock lock(mutex_);
  Hand& hand = hands_[static_cast<std::size_t>(state.hand)];
  hand.state = state;
  hand.heard = now;
  hand.states_awaited = std::max(0, hand.states_awaited - 1);
  const bool is_ours = state.session == hand.session && (state.owner == hand.owner || state.owner == 0);
  if (!is_ours) hand.page = 0;
}

/// True from the moment at which a page gives the hand back until the device confirms it with a new session number. The
/// device would ignore a wish with the old number.
bool HandDesk::is_being_left(const Hand& hand) {
  return hand.page == 0 && hand.states_awaited > 0 && hand.state->session == hand.session;
}

bool HandDesk::listens(const Hand& hand, Clock::time_point now) { return hand.state && now - hand.heard <= kDeafAfter; }

json HandDesk::told(Clock::time_point now) const {
  const std::scoped_lock lock(mutex_);
  json all{{"scale", workspace_ ? workspace_->scale : 0.0}};
  for (std::size_t i = 0; i < kSides.size(); ++i) {
    const bool is_there = listens(hands_[i], now);
    all[kSides[i]] = {
        {"listens", is_there},
        {"free", is_there && hands_[i].page == 0 && hands_[i].state->owner == 0 && !is_being_left(hands_[i])},
        {"page", hands_[i].page}};
    if (hands_[i].page != 0 && workspace_) all[kSides[i]]["p_W"] = place_of(hands_[i]);
  }
  return all;
}

}  // namespace ligature::host::view

// NOLINTEND(bugprone-unchecked-optional-access)
