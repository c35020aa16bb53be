// Compares the presets for named sutures with the table of published data (tests/reference/08_sutures.json): values
// with a source there must agree, and those without must be listed as assumed in rod_keys.hpp.

#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>
#include <set>
#include <string>

#include "ligature_source_dir.hpp"
#include "protocol/scene/rod_keys.hpp"
#include "protocol/scene/scene_file.hpp"
#include "tests/support/temp_folder.hpp"

namespace ligature::scene {
namespace {

nlohmann::json known() {
  std::ifstream file(LIGATURE_SOURCE_DIR "/tests/reference/08_sutures.json");
  return nlohmann::json::parse(file);
}

/// Splits a name like "nylon-3-0" into material and size.
std::pair<std::string, std::string> parts_of(const std::string& name) {
  const auto dash = name.find('-');
  return {name.substr(0, dash), name.substr(dash + 1)};
}

Suture read(const std::string& preset) {
  const auto path = test::temp_folder() + "preset.toml";
  std::ofstream(path) << "[suture]\nmodel = \"rod\"\npreset = \"" << preset << "\"\n";
  return std::get<Scene>(load_scene(path)).suture;
}

TEST(RodPresets, AreInTheMiddleOfTheirSize) {
  const auto table = known();
  for (const auto& p : kRodPresets) {
    const auto size = parts_of(p.name).second;
    bool found = false;
    for (const auto& s : table.at("sizes")) {
      if (s.at("usp") != size) continue;
      found = true;
      const double least_m = 1e-3 * s.at("d_min_mm").get<double>(), most_m = 1e-3 * s.at("d_max_mm").get<double>();
      EXPECT_NEAR(p.diameter_m, 0.5 * (least_m + most_m), 1e-6) << p.name;
    }
    EXPECT_TRUE(found) << p.name;
  }
}

TEST(RodPresets, HaveTheSourcedDensitiesAndModuli) {
  const auto table = known();
  const auto density = table.at("density_g_cm3"), modulus = table.at("modulus_MPa");
  const std::map<std::string, std::string> densities{
      {"nylon", "nylon 6 and 6.6"}, {"polypropylene", "polypropylene"}, {"silk", "silk"}};
  const std::map<std::string, std::string> moduli{
      {"nylon", "nylon 6.6 textile fibre medium tenacity (derived 3.0 N/tex x 1.14)"},
      {"silk", "silk suture 3-0 (braided, initial modulus)"},
      {"polyglactin", "polyglactin 910 rapid 3-0 (initial modulus)"}};
  std::set<std::string> assumed;
  for (const auto& p : kRodPresets) {
    const auto material = parts_of(p.name).first;
    if (densities.contains(material)) {
      EXPECT_NEAR(p.density_kg_per_m3, 1e3 * density.at(densities.at(material)).get<double>(), 1e-6) << p.name;
    } else {
      assumed.insert("density of " + material);
    }
    if (moduli.contains(material)) {
      EXPECT_NEAR(p.modulus_Pa / (1e6 * modulus.at(moduli.at(material)).get<double>()), 1.0, 2e-4) << p.name;
    } else {
      assumed.insert("modulus of " + material);
    }
    EXPECT_EQ(p.bend_share == 1.0, material == "nylon" || material == "polypropylene") << p.name;
  }
  // rod_keys.hpp lists these as assumed; a further one must be added there first.
  EXPECT_EQ(assumed, (std::set<std::string>{"density of polyglactin", "modulus of polypropylene"}));
}

TEST(RodPresets, AreTheRodThatTheTableDerives) {  // computed for solid round cross-sections
  const auto table = known();
  const auto& per_m = table.at("linear_density_derived_kg_per_m");
  const auto& bending = table.at("bending_stiffness_derived_Nm2");
  int compared = 0;
  for (const char* size : {"2-0", "3-0", "4-0"}) {
    const Suture nylon = read(std::string("nylon-") + size);
    const double d_m = 2.0 * nylon.radius_m;
    for (const auto& [key, value] : per_m.items()) {
      if (!key.starts_with(std::string("nylon monofilament ") + size)) continue;
      EXPECT_NEAR(nylon.rod.density_kg_per_m / value.get<double>(), 1.0, 1e-9) << size;
      ++compared;
    }
    for (const auto& [key, value] : bending.items()) {
      if (key.find(std::to_string(1e3 * d_m).substr(0, 5)) == std::string::npos) continue;
      EXPECT_NEAR(nylon.rod.EI_N_m2 / value.get<double>(), 1.0, 1e-9) << size;
      ++compared;
    }
    EXPECT_NEAR(nylon.rod.EA_N, 3.42e9 * std::numbers::pi * d_m * d_m / 4.0, 1e-6) << size;
    EXPECT_NEAR(nylon.rod.GJ_N_m2, nylon.rod.EI_N_m2 / 1.4, 1e-15) << size;
    const Suture silk = read(std::string("silk-") + size);
    EXPECT_NEAR(silk.rod.EI_N_m2, 0.1 * 8.70e9 * std::numbers::pi * d_m * d_m * d_m * d_m / 64.0, 1e-15) << size;
  }
  EXPECT_EQ(compared, 6);
}

TEST(RodPresets, AreAllThreadsOfTheFourSizes) {
  std::set<std::string> names;
  for (const auto& p : kRodPresets) names.insert(p.name);
  for (const char* material : {"nylon", "polypropylene", "silk", "polyglactin"}) {
    for (const char* size : {"2-0", "3-0", "4-0", "5-0"}) {
      EXPECT_TRUE(names.contains(std::string(material) + "-" + size)) << material << size;
    }
  }
}

}  // namespace
}  // namespace ligature::scene
