#include "firmware/app/scene_preview.hpp"

#include <algorithm>
#include <cstdio>
#include <limits>
#include <sstream>
#include <string>
#include <variant>
#include <vector>

#include "protocol/scene/csv.hpp"
#include "protocol/scene/scene_file.hpp"
#include "protocol/scene/text_file.hpp"

namespace ligature::app {
namespace {

constexpr std::size_t kMostAbout = 300;  // characters
constexpr std::size_t kMostPoints = 48;

/// The comment at the beginning of a scene file, on one line.
std::string head_comment(const std::string& toml) {
  std::istringstream lines(toml);
  std::string about;
  for (std::string line; std::getline(lines, line) && line.starts_with('#');) {
    const auto from = line.find_first_not_of("# ");
    if (from != line.npos) about += (about.empty() ? "" : " ") + line.substr(from);
  }
  return about;
}

std::string millimetres(double length_m) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g mm", 1e3 * length_m);
  return text;
}

std::string facts_of(const scene::Scene& s) {
  char text[64];
  std::snprintf(text, sizeof text, "%.3g m", s.suture.length_m);
  std::string facts = std::string(scene::name(s.suture.model)) + ", " + std::to_string(s.suture.nodes) + " nodes, " +
                      text + " long, " + millimetres(2.0 * s.suture.radius_m) + " thick";
  const auto held = s.world.fixed.size();
  facts += held == 0 ? ", free" : ", fixed at " + std::to_string(held) + (held == 1 ? " node" : " nodes");
  if (s.world.desk_height_m) facts += ", on a desk";
  if (!s.world.pegs.empty()) facts += ", " + std::to_string(s.world.pegs.size()) + " pegs";
  if (s.world.grippers_collide) facts += ", grippers collide";
  return facts;
}

/// At most kMostPoints points of the start shape: those of the scene's file of points or, without such a file, the two
/// ends of a thread that hangs straight down, with its first fixed node where the scene fixes it.
std::vector<scene::Vec> start_shape(const scene::Scene& s) {
  const auto& line = s.suture.initial_polyline_m;
  if (line.empty()) {
    scene::Vec at{0.0, 0.0, s.suture.length_m};
    double above_m = 0.0;
    if (!s.world.fixed.empty()) {
      const auto& first = s.world.fixed.front();
      at = first.position_m;
      above_m = s.suture.length_m * (first.node < 0 ? 1.0 : first.node / (s.suture.nodes - 1.0));
    }
    const double top_m = at[2] + above_m;
    return {{at[0], at[1], top_m}, {at[0], at[1], top_m - s.suture.length_m}};
  }
  const std::size_t n = std::min(line.size(), kMostPoints);
  std::vector<scene::Vec> shape;
  shape.reserve(n);
  for (std::size_t i = 0; i < n; ++i) shape.push_back(line[i * (line.size() - 1) / (n - 1)]);
  return shape;
}

}  // namespace

ligature_msg::preview_t preview_of(const std::filesystem::path& file, std::span<const std::string> overrides) {
  ligature_msg::preview_t preview{};
  preview.desk_height_m = std::numeric_limits<float>::quiet_NaN();
  const auto read = scene::read_text(file, scene::kMostScene_bytes);
  if (const auto* error = std::get_if<scene::Error>(&read)) {
    preview.about = scene::shortened(error->text, kMostAbout);
    return preview;
  }
  const auto& text = std::get<std::string>(read);
  const auto loaded = scene::parse_scene(text, file, overrides);
  if (const auto* error = std::get_if<scene::Error>(&loaded)) {
    preview.about = scene::shortened(error->text, kMostAbout);
    return preview;
  }
  const auto& scene = std::get<scene::Scene>(loaded);
  preview.about = scene::shortened(head_comment(text), kMostAbout);
  preview.facts = facts_of(scene);
  if (scene.world.desk_height_m) preview.desk_height_m = static_cast<float>(*scene.world.desk_height_m);
  for (const auto& p : start_shape(scene))
    preview.p_W_m.push_back({static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2])});
  preview.point_count = static_cast<std::int32_t>(preview.p_W_m.size());
  return preview;
}

}  // namespace ligature::app
