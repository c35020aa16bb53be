// Device files (TOML records of a haptic device): shipped ones can be read, and errors are reported in one line.
#include "protocol/device/device_file.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <set>

#include "ligature_source_dir.hpp"
#include "protocol/can/device_profile.hpp"

namespace ligature::device {
namespace {

const std::string kFolder = std::string(LIGATURE_SOURCE_DIR) + "/scenes/devices/";

std::string text_of(const std::string& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

std::string refusal(const std::string& text) {
  const auto parsed = parse_device(text, "d.toml");
  const auto* error = std::get_if<scene::Error>(&parsed);
  return error != nullptr ? error->text : "taken";
}

TEST(DeviceFile, ShippedRecordsLoadAndMarkEveryValue) {
  for (const char* file :
       {"omni.toml", "cartesian.toml", "epos4.toml", "generic-cia402.toml", "odrive.toml", "moteus.toml"}) {
    const auto loaded = load_device_file(kFolder + file);
    ASSERT_TRUE(std::holds_alternative<DeviceFile>(loaded)) << std::get<scene::Error>(loaded).text;
    const auto& sources = std::get<DeviceFile>(loaded).sources;
    std::set<std::string> keys;
    for (const auto& [key, source] : sources) keys.insert(key);
    EXPECT_EQ(keys.size(), sources.size());
    // ODrives report no torque, so that a tolerance for it would say nothing
    EXPECT_EQ(keys.size(), std::get<DeviceFile>(loaded).device.odrive ? 21U : 22U) << file;
  }
}

TEST(DeviceFile, TheBuiltInOneIsTheShippedOmni) {
  const auto loaded = std::get<Device>(load_device(kFolder + "omni.toml"));
  EXPECT_EQ(omni().name, loaded.name);
  EXPECT_EQ(omni().links_m, loaded.links_m);
  EXPECT_EQ(omni().hand_acceleration_m_per_s2, loaded.hand_acceleration_m_per_s2);
}

TEST(DeviceFile, OmniSaysWhatTheWireWasMadeFor) {
  EXPECT_EQ(omni().counts_per_revolution(), can::profile::kCountsPerRevolution);
  EXPECT_DOUBLE_EQ(omni().rated_torque_Nm, can::profile::kRatedTorque_mNm * 1e-3);
  EXPECT_EQ(omni().max_torque_permille, can::profile::kMaxTorque_permille);
}

TEST(DeviceFile, RefusesInOneLineWithPlaceAndAllowed) {
  const std::string good = text_of(kFolder + "omni.toml");
  EXPECT_EQ(refusal(good), "taken");
  const std::string unmarked =
      refusal(replaced(good, "peak_force_N = {value = 3.3, source = \"datasheet\"}", "peak_force_N = 3.3"));
  EXPECT_NE(unmarked.find("limits.peak_force_N"), std::string::npos) << unmarked;
  EXPECT_NE(unmarked.find("d.toml:"), std::string::npos) << unmarked;
  const std::string rumour =
      refusal(replaced(good, "value = 3.3, source = \"datasheet\"", "value = 3.3, source = \"rumour\""));
  EXPECT_NE(rumour.find("one of \"assumed\", \"datasheet\", \"measured\""), std::string::npos) << rumour;
  const std::string missing = refusal(replaced(good, "gear = {value = 1.0, source = \"assumed\"}", ""));
  EXPECT_NE(missing.find("key 'gear' is missing"), std::string::npos) << missing;
  const std::string order = refusal(replaced(good, "value = 0.88", "value = 4.0"));
  EXPECT_NE(order.find("at most peak_force_N"), std::string::npos) << order;
  const std::string kind = refusal(replaced(good, "\"omni-serial\"", "\"stewart\""));
  EXPECT_NE(kind.find("\"omni-serial\", \"cartesian\""), std::string::npos) << kind;
  EXPECT_NE(refusal(replaced(good, "[feel]", "[fell]")).find("no [feel] table"), std::string::npos);
  EXPECT_NE(refusal("x = [").find("not TOML"), std::string::npos);
  EXPECT_EQ(std::count(order.begin(), order.end(), '\n'), 0);
}

}  // namespace
}  // namespace ligature::device
