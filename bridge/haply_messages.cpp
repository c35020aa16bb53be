#include "bridge/haply_messages.hpp"

#include <cmath>
#include <initializer_list>
#include <nlohmann/json.hpp>

#include "protocol/can/device_profile.hpp"

namespace ligature::bridge {
namespace {

using Json = nlohmann::json;

constexpr const char* kGrips[] = {"wireless_verse_grip", "verse_grip"};
constexpr const char* kListsOfGrips[] = {"wireless_verse_grip", "verse_grip", "custom_verse_grip"};

const Json* member(const Json& json, const std::string& key) {
  if (!json.is_object()) return nullptr;
  const auto found = json.find(key);
  return found == json.end() ? nullptr : &*found;
}

/// The entry of the message's list `key` whose device_id is `id`; with an empty `id`, the first entry.
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

/// Updates `missing`, the set of facts (such as "connected") that are false: adds a fact that the message reports as
/// false, and removes one that it reports as true. A fact that a message leaves out stays as it was.
void read_status(const Json& device, std::initializer_list<const char*> facts, std::set<std::string>& missing) {
  const Json* const status = member(device, "status");
  if (status == nullptr) return;
  for (const char* fact : facts) {
    const Json* const value = member(*status, fact);
    if (value == nullptr || !value->is_boolean()) continue;
    if (value->get<bool>())
      missing.erase(fact);
    else
      missing.insert(fact);
  }
}

void note_grips(const Json& message, std::set<std::string>& grips) {
  for (const char* kind : kListsOfGrips) {
    const Json* const list = member(message, kind);
    if (list == nullptr || !list->is_array()) continue;
    for (const Json& grip : *list) {
      const Json* const id = member(grip, "device_id");
      if (id != nullptr && id->is_string()) grips.insert(id->get<std::string>());
    }
  }
}

/// A grip that is not in the message, that is asleep or that is not connected must not count as a pressed dead-man. If
/// the service lists several grips, only the one that the user has named counts: another one may be in the other hand.
void read_buttons(const Json& message, const HaplyChoice& choice, HaplyState& known) {
  known.state.buttons = 0;
  note_grips(message, known.grips);
  if (choice.grip_id.empty() && known.grips.size() > 1) {
    known.problem = "several grips are connected; remedy: --grip-id";
    return;
  }
  for (const char* kind : kGrips) {
    const Json* const grip = device_in(message, kind, choice.grip_id);
    if (grip == nullptr) continue;
    read_status(*grip, {"connected", "awake", "ready"}, known.grip_missing);
    const Json* const sent = member(*grip, "state");
    if (sent == nullptr || !known.grip_missing.empty()) continue;
    namespace profile = can::profile;
    known.state.buttons =
        static_cast<std::uint16_t>((is_pressed(*sent, choice.grip) ? profile::kButtonGrip : 0) |
                                   (is_pressed(*sent, choice.dead_man) ? profile::kButtonDeadMan : 0) |
                                   (is_pressed(*sent, choice.clutch) ? profile::kButtonClutch : 0));
    return;
  }
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
  read_status(*device, {"ready", "calibrated", "power_supply"}, before.missing);
  before.problem.clear();
  for (const auto& fact : before.missing) before.problem += (before.problem.empty() ? "not " : ", not ") + fact;
  if (before.problem.empty()) read_buttons(message, choice, before);
  return before;
}

std::string haply_command(const std::string& inverse3_id, const Vec& force_D_N, bool is_first) {
  const Json vector{{"x", force_D_N[0]}, {"y", force_D_N[1]}, {"z", force_D_N[2]}};
  Json message{{"inverse3", Json::array({{{"device_id", inverse3_id},
                                          {"commands", {{"set_cursor_force", {{"vector", vector}}}}}}})}};
  if (is_first) message["session"] = {{"configure", {{"profile", {{"name", "ligature-bridge"}}}}}};
  return message.dump();
}

}  // namespace ligature::bridge
