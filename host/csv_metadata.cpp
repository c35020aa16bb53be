#include "host/csv_metadata.hpp"

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>

#include "host/tick_columns.hpp"

namespace ligature::host {
namespace {

using nlohmann::ordered_json;

struct Words {
  std::string unit, meaning, type;
};

Words words_of(const std::string& name) {
  const auto found = std::ranges::find(tick_columns(), name, &TickColumn::name);
  if (found != tick_columns().end())
    return {found->unit, found->meaning, std::holds_alternative<TickColumn::Real>(found->value) ? "number" : "integer"};
  if (name == "t_s") return {"s", kTimeMeaning, "number"};
  if (name == "session") return {"", kSessionMeaning, "integer"};
  if (name == "node") return {"", "number of the node along the thread, from 0", "integer"};
  if (name.ends_with("_device_f_N")) return {"N", "magnitude of the force commanded to the device", "number"};
  if (name.ends_with("_world_f_N"))
    return {"N", "magnitude of the thread's force on the hand in world units: its tension there", "number"};
  return {"m", "position of the node in the world frame W (x right, y away, z up)", "number"};
}

}  // namespace

std::string csv_metadata(const std::string& table_path, const std::string& header, const RigFacts& facts,
                         const std::string& source, const std::string& notes) {
  ordered_json columns = ordered_json::array();
  std::istringstream names(header.substr(0, header.find('\n')));
  for (std::string name; std::getline(names, name, ',');) {
    const Words words = words_of(name);
    columns.push_back({{"name", name}, {"titles", name}, {"dc:description", words.meaning}, {"datatype", words.type}});
    if (!words.unit.empty()) columns.back()["ligature:unit"] = words.unit;
  }
  const ordered_json metadata{{"@context", {"http://www.w3.org/ns/csvw", {{"ligature", "urn:ligature:"}}}},
                              {"url", std::filesystem::path(table_path).filename().string()},
                              {"dc:source", source},
                              {"ligature:host_version", LIGATURE_VERSION},
                              {"ligature:firmware_version", facts.firmware_version},
                              {"ligature:period_s", facts.period_s},
                              {"ligature:max_force_N", facts.max_force_N},
                              {"ligature:scene_file", facts.scene_file},
                              {"ligature:scene_toml", facts.scene_toml},
                              {"ligature:notes", notes},
                              {"tableSchema", {{"columns", columns}}}};
  return metadata.dump(1, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace ligature::host
