#include "bridge/haply_messages.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

#include "protocol/can/device_profile.hpp"

namespace ligature::bridge {
namespace {

using Json = nlohmann::json;

const Json* member(const Json& json, const std::string& key) {
  if (!json.is_object()) return nullptr;
  const auto found = json.find(key);
  return found == json.end() ? nullptr : &*found;
}

/// The entry of the list `key` with this device_id; the first one for an empty id.
const Json* device_in(const Json& message, const char* key, const std::string& id) {
  const Json* const list = member(message, key);
  if (list == nullptr || !list->is_array()) return nullptr;
  for (const Json& device : *list) {
    const Json* const own = member(device, "device_id");
    if (own != nullptr && own->is_string() && (id.empty() || *own == id)) return &device;
  }
  return nullptr;
}

std::optional<Vec> vector_in(const Json& json) {
  constexpr std::array<const char*, 3> kAxes{"x", "y", "z"};
  Vec v{};
  for (std::size_t i = 0; i < 3; ++i) {
    const Json* const value = member(json, kAxes[i]);
    if (value == nullptr || !value->is_number()) return std::nullopt;
    v[i] = value->get<double>();
    if (!std::isfinite(v[i])) return std::nullopt;
  }
  return v;
}

bool is_pressed(const Json& state, const std::string& button) {
  const Json* const buttons = member(state, "buttons");
  const Json* const value = buttons != nullptr ? member(*buttons, button) : nullptr;
  return value != nullptr && value->is_boolean() && value->get<bool>();
}

/// The status is sent when it changes; each of its facts that is false makes the device unusable.
void read_status(const Json& device, std::string& problem) {
  const Json* const status = member(device, "status");
  if (status == nullptr) return;
  problem.clear();
  for (const char* fact : {"ready", "calibrated", "power_supply"}) {
    const Json* const value = member(*status, fact);
    if (value != nullptr && value->is_boolean() && !value->get<bool>())
      problem += (problem.empty() ? "not " : ", not ") + std::string(fact);
  }
}

void read_buttons(const Json& message, const HaplyChoice& choice, DeviceState& state) {
  for (const char* kind : {"wireless_verse_grip", "verse_grip"}) {
    const Json* const grip = device_in(message, kind, choice.grip_id);
    const Json* const sent = grip != nullptr ? member(*grip, "state") : nullptr;
    if (sent == nullptr) continue;
    namespace profile = can::profile;
    state.buttons = static_cast<std::uint16_t>((is_pressed(*sent, choice.grip) ? profile::kButtonGrip : 0) |
                                               (is_pressed(*sent, choice.dead_man) ? profile::kButtonDeadMan : 0) |
                                               (is_pressed(*sent, choice.clutch) ? profile::kButtonClutch : 0));
    return;
  }
  state.buttons = 0;  // a grip that is not in the message must not hold the dead-man
}

}  // namespace

std::optional<HaplyState> read_haply(std::string_view text, const HaplyChoice& choice, HaplyState& before) {
  const Json message = Json::parse(text, nullptr, false);
  const Json* const device = device_in(message, "inverse3", choice.inverse3_id);
  const Json* const state = device != nullptr ? member(*device, "state") : nullptr;
  const Json* const position = state != nullptr ? member(*state, "cursor_position") : nullptr;
  const auto p = position != nullptr ? vector_in(*position) : std::nullopt;
  if (!p) return std::nullopt;
  before.inverse3_id = device->at("device_id").get<std::string>();
  before.state.p_D_m = *p;
  read_status(*device, before.problem);
  read_buttons(message, choice, before.state);
  return before;
}

std::string haply_command(const std::string& inverse3_id, const Vec& force_D_N, bool is_first) {
  const Json values{{"x", force_D_N[0]}, {"y", force_D_N[1]}, {"z", force_D_N[2]}};
  Json message{{"inverse3", Json::array({{{"device_id", inverse3_id},
                                          {"commands", {{"set_cursor_force", {{"values", values}}}}}}})}};
  if (is_first) message["session"] = {{"configure", {{"profile", {{"name", "ligature-bridge"}}}}}};
  return message.dump();
}

}  // namespace ligature::bridge
