// Compares docs/scene.md with the readers: every key, column and rule on the page with unit, default and allowed
// values.
// A failure prints the row as the page should have it.

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <fstream>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "ligature_source_dir.hpp"
#include "protocol/device/device_file.hpp"
#include "protocol/device/device_keys.hpp"
#include "protocol/scene/csv.hpp"
#include "protocol/scene/fault_script.hpp"
#include "protocol/scene/gripper_script.hpp"
#include "protocol/scene/key_list.hpp"
#include "protocol/scene/polyline.hpp"
#include "protocol/scene/rod_keys.hpp"
#include "protocol/scene/scene_file.hpp"
#include "protocol/scene/text_file.hpp"
#include "tests/support/temp_folder.hpp"

namespace ligature::scene {
namespace {

using Rows = std::vector<std::string>;

std::string text_of(const std::string& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

const std::string& page() {
  static const std::string text = text_of(LIGATURE_SOURCE_DIR "/docs/scene.md");
  return text;
}

/// The rows of all tables whose header line begins with `header`, in the page's order.
Rows rows_below(const std::string& header) {
  Rows rows;
  bool inside = false;
  std::istringstream lines(page());
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with("|")) inside = false;
    if (inside && !line.starts_with("|---")) rows.push_back(line);
    if (line.starts_with(header)) inside = true;
  }
  return rows;
}

/// Compares the page's tables that have this header with the wanted rows. Each wanted row must be the beginning of
/// exactly one table row, and no table row may be left over. The last cell, the meaning, may be any text but not empty.
void hold(const std::string& header, const Rows& wanted) {
  Rows left = rows_below(header);
  for (const auto& want : wanted) {
    const auto starts = [&](const std::string& row) { return row.starts_with(want); };
    EXPECT_EQ(std::ranges::count_if(left, starts), 1) << "docs/scene.md needs one row that starts with\n" << want;
    for (const auto& row : left) {
      if (starts(row)) {
        EXPECT_GE(row.size(), want.size() + 6) << "no meaning: " << row;
      }
    }
    std::erase_if(left, starts);
  }
  for (const auto& row : left) ADD_FAILURE() << "docs/scene.md has a row that no reader has\n" << row;
}

/// Numbers as people write them: 1e-6 and 1e9, not 1e-06 and 1e+09.
std::string plain(const std::string& text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    out += text[i];
    const bool exponent = text[i] == 'e' && i > 0 && std::isdigit(static_cast<unsigned char>(text[i - 1])) != 0 &&
                          i + 2 < text.size() && (text[i + 1] == '+' || text[i + 1] == '-');
    if (!exponent) continue;
    if (text[i + 1] == '-') out += '-';
    i += text[i + 2] == '0' ? 2 : 1;
  }
  return out;
}

/// Unit of a key: the ending of its name; a few names have none.
std::string unit_of(const std::string& key) {
  static const std::map<std::string, std::string> kNamed{
      {"stretch_damping", "N s/m"},         {"bend", "N m"},      {"bend_damping", "N m s"}, {"swivel_damping", "N s"},
      {"motor_counts", "counts"},           {"counts", "counts"}, {"counts_unit", "counts"}, {"within_ticks", "ticks"},
      {"work_instructions", "instructions"}};
  static const std::vector<std::pair<std::string, std::string>> kEndings{{"_N_s_per_m", "N s/m"},
                                                                         {"_kg_per_m", "kg/m"},
                                                                         {"_N_per_m", "N/m"},
                                                                         {"_Nm_per_A", "N m/A"},
                                                                         {"_m_per_s2", "m/s²"},
                                                                         {"_m_per_s", "m/s"},
                                                                         {"_N_per_s", "N/s"},
                                                                         {"_per_m", "1/m"},
                                                                         {"_per_s", "1/s"},
                                                                         {"_N_m2", "N m²"},
                                                                         {"_Nm", "N m"},
                                                                         {"_permille", "per mille"},
                                                                         {"permille", "per mille"},
                                                                         {"_rad", "rad"},
                                                                         {"_kg", "kg"},
                                                                         {"_N", "N"},
                                                                         {"_J", "J"},
                                                                         {"_m", "m"},
                                                                         {"_ms", "ms"},
                                                                         {"_s", "s"}};
  const std::string last = key.substr(key.rfind('.') + 1);
  if (const auto named = kNamed.find(last); named != kNamed.end()) return named->second;
  for (const auto& [ending, unit] : kEndings) {
    if (last.ends_with(ending)) return unit;
  }
  return "-";
}

std::string models_of(const KeyRow& row) {
  if (row.owner.empty()) return "all";
  return row.owner.find("\"rod\"") != std::string::npos ? "rod" : "paper";
}

TEST(ScenePage, HasEveryKeyOfAScene) {
  const auto paper = scene_keys(Model::kPaper4), rod = scene_keys(Model::kRod);
  ASSERT_EQ(paper.size(), rod.size());
  Rows wanted;
  for (std::size_t i = 0; i < paper.size(); ++i) {
    KeyRow row = paper[i];
    ASSERT_EQ(row.key, rod[i].key);
    if (row.allowed == "a table") continue;  // the tables are the page's headings
    if (row.standard != rod[i].standard) row.standard = "paper " + row.standard + ", rod " + rod[i].standard;
    if (row.key.ends_with("[].node") && row.allowed == "integer -1 .. " + std::to_string(Suture{}.nodes - 1))
      row.allowed = "integer -1 .. nodes - 1";
    wanted.push_back("| `" + row.key + "` | " + models_of(row) + " | " + unit_of(row.key) + " | " +
                     plain(row.standard) + " | " + plain(row.allowed) + " |");
  }
  hold("| key | models |", wanted);
}

TEST(ScenePage, HasEveryKeyOfADeviceRecord) {
  const auto keys = device::device_keys();
  Rows wanted;
  std::string source;
  for (std::size_t i = 0; i < keys.size(); ++i) {
    KeyRow row = keys[i];
    if (row.key.ends_with(".source") && row.key != "cia402.source" && row.key != "odrive.source" &&
        row.key != "moteus.source") {
      EXPECT_EQ(row.standard, "required");
      source = row.allowed;
      EXPECT_NE(page().find(source), std::string::npos) << source;
    } else if (row.key.ends_with(".value")) {  // the row before is the entry itself
      row.key.resize(row.key.rfind('.'));
      ASSERT_EQ(keys[i - 1].key, row.key);
      // If the key is left out, the program's initial value stays.
      row.standard =
          keys[i - 1].standard == "required" ? "required" : std::to_string(device::Device{}.torque_tolerance_permille);
      wanted.push_back("| `" + row.key + "` | " + unit_of(row.key) + " | " + row.standard + " | " + plain(row.allowed) +
                       " |");
    } else if (row.allowed != "a table") {
      wanted.push_back("| `" + row.key + "` | " + unit_of(row.key) + " | " + plain(row.standard) + " | " +
                       plain(row.allowed) + " |");
    }
  }
  hold("| device key |", wanted);
}

TEST(ScenePage, HasEveryKeyOfAFaultScript) {
  Rows wanted;
  for (const auto& row : fault_keys()) {
    if (row.allowed == "a table") continue;
    wanted.push_back("| `" + row.key + "` | " + unit_of(row.key) + " | " + plain(row.standard) + " | " +
                     plain(row.allowed) + " |");
  }
  hold("| fault key |", wanted);
}

TEST(ScenePage, HasEveryPreset) {
  Rows wanted;
  const auto digits = [](double v) {
    std::ostringstream s;
    s.precision(3);
    s << v;
    return plain(s.str());
  };
  for (const auto& p : kRodPresets) {
    const std::string set = std::string("suture.preset=") + p.name;
    const auto read = parse_scene("[suture]\nmodel = \"rod\"\n", "scene.toml", std::vector{set});
    ASSERT_TRUE(std::holds_alternative<Scene>(read)) << std::get<Error>(read).text;
    const auto& s = std::get<Scene>(read).suture;
    wanted.push_back(std::string("| `") + p.name + "` | " + digits(s.radius_m) + " | " +
                     digits(s.rod.density_kg_per_m) + " | " + digits(s.rod.EA_N) + " | " + digits(s.rod.EI_N_m2) +
                     " | " + digits(s.rod.GJ_N_m2) + " |");
  }
  Rows left = rows_below("| preset |");
  EXPECT_EQ(left, wanted);
}

std::string written(const std::string& name, const std::string& text) {
  const auto path = test::temp_folder() + name;
  std::ofstream(path) << text;
  return path;
}

/// What the reader allows, from its message; or "taken".
template <class Read>
std::string allowed_by(const Read& read) {
  const auto* error = std::get_if<Error>(&read);
  if (error == nullptr) return "taken";
  const auto at = error->text.find(", allowed ");
  return at == std::string::npos ? error->text : error->text.substr(at + 10);
}

/// Both headers of operator scripts, from the reader's message.
std::vector<std::string> headers() {
  const std::string told = allowed_by(load_gripper_script(written("s.csv", "nonsense\n")));
  std::vector<std::string> found;
  for (std::size_t a = told.find('\''); a != std::string::npos; a = told.find('\'', a)) {
    const auto b = told.find('\'', a + 1);
    found.push_back(told.substr(a + 1, b - a - 1));
    a = b + 1;
  }
  return found;
}

TEST(ScenePage, HasEveryColumnOfAnOperatorScript) {
  const auto header = headers();
  ASSERT_EQ(header.size(), 2U);
  const auto narrow = split(header[0]), wide = split(header[1]);
  Rows wanted;
  for (std::size_t i = 0; i < wide.size(); ++i) {
    // A value beyond every range, and no number: the reader's two messages.
    const auto told = [&](const std::string& cell) {
      std::string row;
      for (std::size_t k = 0; k < wide.size(); ++k) {
        const std::string good = wide[k] == "hand" ? "L" : "0";
        row += (k > 0 ? "," : "") + (k == i ? cell : good);
      }
      return allowed_by(load_gripper_script(written("s.csv", header[1] + "\n" + row + "\n")));
    };
    const std::string column(wide[i]);
    const bool is_number = told("x") == "a finite number";
    const std::string unit = column == "time" ? "s" : !is_number ? "-" : column.starts_with("turn") ? "degrees" : "m";
    wanted.push_back("| `" + column + "` | " + unit + " | " + (i < narrow.size() ? "required" : "0") + " | " +
                     told(is_number ? "-1e9" : "x") + " |");
  }
  wanted.push_back("| `motion` | - | rests | " +
                   allowed_by(load_gripper_script(written("s.csv", "motion,x\n" + header[0] + "\n0,L,0,0,0,0\n"))) +
                   " |");
  hold("| column |", wanted);
  for (const auto& each : header) EXPECT_NE(page().find(each), std::string::npos) << each;
  GripperScript none;
  EXPECT_EQ(none.motion, Motion::kRests);  // the default
  EXPECT_EQ(allowed_by(load_gripper_script(written("s.csv", "motion,rests\n" + header[0] + "\n0,L,0,0,0,0\n"))),
            "taken");
}

TEST(ScenePage, HasEveryColumnOfAStartShape) {
  const std::string header = allowed_by(load_polyline(written("p.csv", "nonsense\n")));
  EXPECT_EQ(header, "the header 'x,y,z'");
  const std::string range = allowed_by(load_polyline(written("p.csv", "x,y,z\n0,0,0\n0,0,1e9\n")));
  hold("| shape column |", {"| `x`, `y`, `z` | m | required | " + range + " |"});
  EXPECT_NE(page().find(allowed_by(load_polyline(written("p.csv", "x,y,z\n0,0,0\n"))) + " rows"), std::string::npos);
}

/// A scene, or a device record if `scene` is empty, that breaks a rule between several keys.
struct Broken {
  std::string key;
  std::string scene;
  std::string from{}, to{};  // a change of the shipped record
};

TEST(ScenePage, HasEveryRuleBetweenKeys) {
  std::string loads = "[suture]\n[world]\nloads = [", pegs = "[suture]\nmodel = \"rod\"\n[world]\npegs = [";
  for (int i = 0; i <= 5000; ++i) loads += "{node = 0, force_N = [0, 0, 0]},";
  for (int i = 0; i <= 100; ++i) pegs += "{from_m = [0, 0, 0], to_m = [0, 0, 0], radius_m = 1},";
  const std::string fixed = "[suture]\n[world]\nfixed = [{node = 1, position_m = [0, 0, 0]";
  const std::string paper = "[suture]\n[contact]\nsolver = \"paper\"\n[world]\n";
  const std::string rod = "[suture]\nmodel = \"rod\"\nlength_m = 5\nstiffness_profile = [";
  std::string regions = rod;
  for (int i = 0; i <= 8; ++i)
    regions += "{from_m = 0." + std::to_string(i) + ", to_m = 0." + std::to_string(i) + "5, EI_N_m2 = 1},";
  const std::vector<Broken> broken{
      {"suture.stiffness_profile", regions + "]\n"},
      {"suture.stiffness_profile[].from_m",
       rod + "{from_m = 1, to_m = 2, EI_N_m2 = 1}, {from_m = 1, to_m = 2, EI_N_m2 = 1}]\n"},
      {"suture.stiffness_profile[].to_m", rod + "{from_m = 1, to_m = 1, EI_N_m2 = 1}]\n"},
      {"suture.stiffness_profile[].to_m", rod + "{from_m = 1, to_m = 6, EI_N_m2 = 1}]\n"},
      {"contact.static_friction", "[suture]\n[contact]\nfriction = 0.3\nstatic_friction = 0.2\n"},
      {"world.fixed[].direction", fixed + ", direction = [0, 0, 0]}]\n"},
      {"world.fixed[].node", fixed + "}, {node = 1, position_m = [0, 0, 0]}]\n"},
      {"world.loads", loads + "]\n"},
      {"world.pegs", pegs + "]\n"},
      {"world.pegs[].surface_m_per_s",
       "[suture]\nmodel = \"rod\"\n[world]\npegs = [{from_m = [0, 0, 0], to_m = [0, 0, 0], radius_m = 1, "
       "surface_m_per_s = 1}]\n"},
      {"world.desk_height_m", paper + "desk_height_m = 0\n"},
      {"world.grippers_collide", paper + "grippers_collide = true\n"},
      {"world.frame_collides", paper + "frame_collides = true\n"},
      {"time.substeps", "[suture]\nnodes = 5000\n[time]\nsubsteps = 401\n"},
      {"hands.reach_m", "[suture]\nradius_m = 0.1\n[hands]\nreach_m = 0.05\n"},
      {"geometry.links_m", {}, "[0.134, 0.1325, 0.0]", "[0.134, 0.0, 0.0]"},
      {"geometry.joint_max_rad", {}, "[0.98, 1.80, 1.25]", "[-2, 1.80, 1.25]"},
      {"geometry.workspace_max_m", {}, "[0.08, -0.16, 0.06]", "[-1, -0.16, 0.06]"},
      {"limits.continuous_force_N", {}, "continuous_force_N = {value = 0.88", "continuous_force_N = {value = 4"}};
  const std::string record = text_of(LIGATURE_SOURCE_DIR "/scenes/devices/omni.toml");
  Rows wanted;
  for (const auto& b : broken) {
    std::string told;
    if (!b.scene.empty()) {
      told = allowed_by(parse_scene(b.scene, "scene.toml"));
    } else {
      const auto at = record.find(b.from);
      ASSERT_NE(at, std::string::npos) << b.from;
      told = allowed_by(device::parse_device(std::string(record).replace(at, b.from.size(), b.to), "device.toml"));
    }
    wanted.push_back("| `" + b.key + "` | " + told + " |");
  }
  hold("| rule for |", wanted);
}

TEST(ScenePage, HasTheLimitsOfFiles) {
  EXPECT_NE(
      page().find("at most " + std::to_string(kMostScene_bytes >> 20) + " MiB; a CSV file has at most " +
                  std::to_string(kMostCsv_bytes >> 20) + " MiB and " + std::to_string(kMostRows / 1000) + ",000 rows"),
      std::string::npos);
}

/// Other tests compare the page with scene_keys(); this one compares scene_keys() with the readers. A reader's message
/// about an unknown key names every key that the reader asks for, so no reader can have a key that is not listed.
TEST(ScenePage, ListsTheKeysThatMessagesName) {
  for (const Model model : {Model::kPaper4, Model::kRod}) {
    for (const char* table : {"suture", "contact", "world", "time", "hands"}) {
      const std::string suture = std::string("[suture]\nmodel = \"") + name(model) + "\"\n";
      const std::string text =
          table == std::string("suture") ? suture + "zz = 1\n" : suture + "[" + table + "]\nzz = 1\n";
      std::string told = allowed_by(parse_scene(text, "scene.toml"));
      std::set<std::string> named, listed;
      for (const auto cell : split(told)) named.emplace(cell);
      for (const auto& row : scene_keys(model)) {
        const std::string path = std::string(table) + ".";
        const bool of_model = row.owner.empty() || (models_of(row) == "rod") == (model == Model::kRod);
        if (of_model && row.key.starts_with(path) && row.key.find("[]") == std::string::npos)
          listed.insert(row.key.substr(path.size()));
      }
      EXPECT_EQ(named, listed) << table;
    }
  }
}

}  // namespace
}  // namespace ligature::scene
