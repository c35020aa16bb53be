#include "host/view/rig_json.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "host/names.hpp"
#include "host/text.hpp"

namespace ligature::host::view {

nlohmann::json to_json(const ligature_msg::status_t& s) {
  return {{"session", s.session},
          {"protocol_version", s.protocol_version},
          {"firmware_version", s.firmware_version},
          {"scene_file", s.scene_file},
          {"scene_toml", s.scene_toml},
          {"period_s", s.period_s},
          {"max_force_N", s.max_force_N},
          {"tick", s.tick},
          {"state", s.state},
          {"fault", s.fault},
          {"deadline_misses", s.deadline_misses},
          {"periods_lost", s.periods_lost},
          {"realtime", s.realtime != 0},
          {"armed", s.armed != 0}};
}

nlohmann::json to_json(const ligature_msg::event_t& e) {
  return {{"tick", e.tick}, {"kind", e.kind}, {"hand", e.hand}, {"code", e.code}, {"text", shortened(e.text, 200)}};
}

namespace {

/// Points that are not finite are left out, because JSON has no numbers for them.
nlohmann::json to_json(const ligature_msg::preview_t& p) {
  constexpr std::size_t kMostPoints = 100;
  nlohmann::json points = nlohmann::json::array();
  for (const auto& point : p.p_W_m)
    if (points.size() < kMostPoints && std::ranges::all_of(point, [](float x) { return std::isfinite(x); }))
      points.push_back(point);
  return {{"about", shortened(p.about, 400)},
          {"facts", shortened(p.facts, 200)},
          {"desk_height_m", std::isfinite(p.desk_height_m) ? nlohmann::json(p.desk_height_m) : nlohmann::json()},
          {"points", std::move(points)}};
}

}  // namespace

nlohmann::json to_json(const ligature_msg::offer_t& o) {
  constexpr std::size_t kMost = 200;
  nlohmann::json scenes = nlohmann::json::array(), previews = scenes, parameters = scenes;
  for (std::size_t i = 0; i < std::min(kMost, o.scenes.size()); ++i) {
    scenes.push_back(o.scenes[i].substr(0, 100));
    if (i < o.previews.size()) previews.push_back(to_json(o.previews[i]));
  }
  for (std::size_t i = 0; i < std::min(kMost, o.parameters.size()); ++i) {
    const auto& p = o.parameters[i];
    parameters.push_back({{"key", p.key.substr(0, 100)},
                          {"name", p.name.substr(0, 100)},
                          {"unit", p.unit.substr(0, 20)},
                          {"value", p.value},
                          {"lowest", p.lowest},
                          {"highest", p.highest}});
  }
  return {{"scenes", std::move(scenes)}, {"previews", std::move(previews)}, {"parameters", std::move(parameters)}};
}

nlohmann::json names_json() {
  nlohmann::json limits, degradations, conditions, faults;
  for (const auto& [bit, name] : kLimitNames) limits.push_back({bit, name});
  for (const auto& [code, name] : kDegradationNames) degradations.push_back({code, name});
  for (const auto& [code, name] : kPropagationNames) conditions.push_back({code, name});
  for (const auto& [number, meaning, remedy] : kFaults) faults.push_back({number, meaning, remedy});
  return {{"states", kStateNames},
          {"limits", limits},
          {"degradations", degradations},
          {"conditions", conditions},
          {"faults", faults}};
}

void write_tick(FrameWriter& frame, const ligature_msg::tick_t& tick) {
  frame.add(static_cast<double>(tick.tick));
  frame.add(static_cast<double>(tick.state));
  frame.add(static_cast<double>(tick.fault));
  frame.add(static_cast<double>(tick.flags));
  for (std::size_t hand = 0; hand < 2; ++hand) {
    frame.add(tick.p_WT_m[hand]);
    frame.add(tick.f_device_N[hand]);
    frame.add(tick.f_world_N[hand]);
    frame.add(static_cast<double>(tick.grip[hand]));
    frame.add(static_cast<double>(tick.dead_man[hand]));
    frame.add(static_cast<double>(tick.grasped_node[hand]));
    frame.add(static_cast<double>(tick.tpdo_age_ticks[hand]));
  }
}

bool is_drawable(const ligature_msg::thread_t& thread) {
  constexpr std::size_t kMostNodes = 5000;  // upper limit of suture.nodes in scene files
  const auto is_finite = [](const auto& p) { return std::ranges::all_of(p, [](float x) { return std::isfinite(x); }); };
  return thread.p_W_m.size() >= 2 && thread.p_W_m.size() <= kMostNodes && std::isfinite(thread.radius_m) &&
         thread.radius_m > 0.0F && std::ranges::all_of(thread.p_W_m, is_finite) && is_finite(thread.tension_N) &&
         is_finite(thread.turn_rad);
}

}  // namespace ligature::host::view
