#include "host/lab/loading.hpp"

#include <utility>

#include "host/lab/outcome.hpp"
#include "protocol/scene/scene_file.hpp"
#include "protocol/scene/text_file.hpp"

namespace ligature::lab {

scene::Scene load_scene_or_refuse(const std::string& path, const std::vector<std::string>& overrides) {
  return parse_scene_or_refuse(read_scene_text_or_refuse(path), path, overrides);
}

std::string read_scene_text_or_refuse(const std::string& path) {
  auto read = scene::read_text(path, scene::kMostScene_bytes);
  if (const auto* error = std::get_if<scene::Error>(&read)) throw Refusal(error->text);
  return std::get<std::string>(std::move(read));
}

scene::Scene parse_scene_or_refuse(const std::string& text, const std::string& path,
                                   const std::vector<std::string>& overrides) {
  auto read = scene::parse_scene(text, path, overrides);
  if (const auto* error = std::get_if<scene::Error>(&read)) throw Refusal(error->text);
  return std::get<scene::Scene>(std::move(read));
}

scene::GripperScript load_script_or_refuse(const std::string& path) {
  auto read = scene::load_gripper_script(path);
  if (const auto* error = std::get_if<scene::Error>(&read)) throw Refusal(error->text);
  return std::get<scene::GripperScript>(std::move(read));
}

physics::Simulation make_or_refuse(const scene::Scene& scene, const std::string& scene_name) {
  auto made = physics::Simulation::make(scene);
  if (const auto* why = std::get_if<std::string>(&made)) throw Refusal(scene_name + ": " + *why);
  return std::get<physics::Simulation>(std::move(made));
}

}  // namespace ligature::lab
