#include "firmware/app/launch.hpp"

#include <algorithm>
#include <cstdio>

#include "protocol/scene/scene_file.hpp"

namespace ligature::app {
namespace {

constexpr const char* kOverridePassivity = "hands.override_passivity=true";
constexpr std::string_view kMaxForce = "hands.max_force_N", kForceScaleKey = "hands.force_scale";

/// Whether an override sets `key`, either itself or as part of a whole TOML table.
bool speaks_of(std::string_view override, std::string_view key) {
  const auto named = key_of(override);
  return key == named || (key.starts_with(named) && key[named.size()] == '.');
}

}  // namespace

std::vector<std::string> launch_overrides(const RunOptions& options) {
  auto all = options.overrides;
  if (options.override_passivity) all.emplace_back(kOverridePassivity);
  return all;
}

Launch::Launch(const RunOptions& options, const scene::Scene& launched)
    : overrides_(launch_overrides(options)), hands_(launched.hands) {}

std::vector<std::string> Launch::with(const std::vector<std::string>& live) const {
  auto all = overrides_;
  std::erase_if(all, [&](const std::string& o) { return std::ranges::find(live, key_of(o), key_of) != live.end(); });
  all.insert(all.end(), live.begin(), live.end());
  return all;
}

std::vector<std::string> Launch::with(const std::vector<std::string>& live, const std::string& file,
                                      const std::string& text) const {
  auto all = with(live), without = all;
  if (std::erase_if(without, [](const std::string& o) { return speaks_of(o, kMaxForce); }) == 0) return all;
  const auto own = scene::parse_scene(text, file, without);
  const auto* scene = std::get_if<scene::Scene>(&own);
  if (scene == nullptr || scene->hands.max_force_N >= hands_.max_force_N) return all;
  char own_limit[64];
  std::snprintf(own_limit, sizeof own_limit, "%s=%.17g", std::string(kMaxForce).c_str(), scene->hands.max_force_N);
  std::erase_if(all, [](const std::string& o) { return key_of(o) == kMaxForce; });
  all.emplace_back(own_limit);
  return all;
}

std::optional<double> Launch::highest(std::string_view key) const {
  const auto bounds = [&](const std::string& o) { return speaks_of(o, key); };
  if (key != kForceScaleKey || !std::ranges::any_of(overrides_, bounds)) return std::nullopt;
  return hands_.force_scale;
}

std::string Launch::held(const std::vector<std::string>& live) const {
  std::string words;
  for (const auto& o : overrides_) {
    if (std::ranges::find(live, key_of(o), key_of) != live.end()) continue;
    words +=
        (words.empty() ? "" : ", ") + (o == kOverridePassivity ? std::string("--override-passivity") : "--set " + o);
  }
  return words;
}

}  // namespace ligature::app
