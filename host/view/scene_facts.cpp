#include "host/view/scene_facts.hpp"

#include <variant>

#include "protocol/scene/recorded_scene.hpp"
#include "protocol/scene/scene_file.hpp"

namespace ligature::host::view {
namespace {

constexpr double kGripperRadii = 4.0;  // firmware/physics/paper/obstacles.hpp
constexpr const char* kInitial = "suture.initial";

}  // namespace

nlohmann::json scene_facts(const std::string& recorded_toml, const std::string& scene_file) {
  auto recorded = scene::split_recorded(recorded_toml);
  // The start shape is not drawn. Its file may be on another machine, and a sender must not choose which file is read.
  std::erase_if(recorded.overrides, [](const std::string& o) { return scene::key_of(o) == kInitial; });
  recorded.overrides.push_back(std::string(kInitial) + "=hanging");
  const auto parsed = scene::parse_scene(recorded.text, scene_file, recorded.overrides);
  const auto* is = std::get_if<scene::Scene>(&parsed);
  if (is == nullptr) return nullptr;
  const bool is_rod = is->suture.model == scene::Model::kRod;
  auto fixed = nlohmann::json::array();
  for (const auto& node : is->world.fixed) fixed.push_back(node.position_m);
  nlohmann::json facts = {{"length_m", is->suture.length_m},
                          {"fixed", std::move(fixed)},
                          {"desk_height_m", nullptr},
                          {"gripper_m", nullptr},
                          {"equal_segments", !is_rod || is->suture.rod.spacing != scene::Spacing::kAdaptive},
                          {"EA_N", nullptr}};
  if (is->world.desk_height_m) facts["desk_height_m"] = *is->world.desk_height_m;
  if (is->world.grippers_collide) facts["gripper_m"] = kGripperRadii * is->suture.radius_m;
  if (is_rod) facts["EA_N"] = is->suture.rod.EA_N;
  return facts;
}

}  // namespace ligature::host::view
