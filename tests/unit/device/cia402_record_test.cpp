// Table [cia402] of device records: the shipped ones, and what is refused.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "ligature_source_dir.hpp"
#include "protocol/device/device_file.hpp"

namespace ligature::device {
namespace {

std::string shipped(const std::string& name) {
  std::ifstream file(std::string(LIGATURE_SOURCE_DIR) + "/scenes/devices/" + name);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// The shipped EPOS4 record with one text replaced. @return what the reader says
std::string with(const std::string& from, const std::string& to) {
  std::string text = shipped("epos4.toml");
  const auto at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  const auto parsed = parse_device(text.replace(at, from.size(), to), "d.toml");
  const auto* error = std::get_if<scene::Error>(&parsed);
  return error != nullptr ? error->text : "taken";
}

Cia402Profile profile_of(const std::string& file) {
  const auto parsed = parse_device(shipped(file), file);
  if (const auto* error = std::get_if<scene::Error>(&parsed)) ADD_FAILURE() << error->text;
  return std::get<DeviceFile>(parsed).device.cia402;
}

TEST(Cia402Record, WithoutTheTableTheDrivesAreOurOwn) {
  for (const char* file : {"omni.toml", "cartesian.toml"}) {
    const Cia402Profile p = profile_of(file);
    EXPECT_EQ(p.watchdog, DriveWatchdog::kRpdoTimer);
    EXPECT_FALSE(p.buttons.are_inputs());
    EXPECT_TRUE(p.optional.empty() && p.writes.empty());
  }
}

TEST(Cia402Record, Epos4) {
  const Cia402Profile p = profile_of("epos4.toml");
  EXPECT_EQ(p.counts, (ObjectAddress{0x3010, 1}));
  EXPECT_EQ(p.counts_unit, 4);
  EXPECT_DOUBLE_EQ(p.rated_torque_unit_Nm, 1e-6);
  EXPECT_TRUE(p.at_motor);
  EXPECT_FALSE(p.max_torque.is_there());
  EXPECT_EQ(p.watchdog, DriveWatchdog::kHeartbeat);
  EXPECT_EQ(p.watchdog_ms, 40);
  ASSERT_EQ(p.writes.size(), 5U);
  EXPECT_EQ(p.writes[0].object, (ObjectAddress{0x1800, 3}));
  EXPECT_EQ(p.writes[0].bytes, 2);
  EXPECT_EQ(p.writes[3].value, 0xFDU) << "-3 in one byte";
}

TEST(Cia402Record, GenericNamesWhatADriveMayLack) {
  const Cia402Profile p = profile_of("generic-cia402.toml");
  EXPECT_EQ(p.optional, (std::vector<ObjectAddress>{{0x6072, 0}}));
  EXPECT_EQ(p.buttons.bits, 32);
}

TEST(Cia402Record, RefusesInOneLine) {
  EXPECT_EQ(with("pdos = 4", "pdos = 2"), "taken");
  const std::pair<std::pair<const char*, const char*>, const char*> bad[] = {
      {{"source = \"assumed\"\ncounts", "counts"}, "key 'source' is missing"},
      {{"\"0x3010:01\"", "\"0x3010\""}, "cia402.counts_object': found '0x3010', allowed an object"},
      {{"\"0x3010:01\"", "\"0x0000:01\""}, "allowed an object"},
      {{"\"0x3010:01\"", "\"0x3010:01x\""}, "allowed an object"},
      {{"\"0x3010:01\"", "\"0x-301:01\""}, "allowed an object"},
      {{"\"0x3141:01\"", "\"none\""}, "cia402.buttons_object': found 'none', allowed an object"},
      {{"buttons_bits = 16", "buttons_bits = 24"}, "allowed 8, 16 or 32"},
      {{"dead_man_bit = 1", "dead_man_bit = 16"}, "less than buttons_bits"},
      {{"grip_bit = 0", "grip_bit = 1"}, "another bit than that of the grip"},
      {{"pdos = 4", "pdos = 1"}, "\"inputs\" only with pdos of 2 or more"},
      {{"\"inputs\"", "\"ligature\""}, "taken"},
      {{"buttons_bits = 16\ngrip_bit = 0", "buttons_bits = 16\ngrip_bit = 5"}, "taken"},
      {{"\"heartbeat\"", "\"prayer\""}, "one of \"rpdo-timer\", \"heartbeat\", \"none\""},
      {{"writes =", "optional = \"0x1016:01\"\nwrites ="}, "no object of the watchdog"},
      {{"writes =", "optional = \"0x3141:01\"\nwrites ="}, "not the buttons"},
      {{"writes =", "optional = \"0x6007:00\"\nwrites ="}, "end the torque"},
      {{"writes =", "optional = \"0x6060:00\"\nwrites ="}, "not the mode"},
      {{"buttons_object = \"0x3141:01\"", ""}, "only with buttons_object and dead_man_bit"},
      {{"dead_man_bit = 1", ""}, "only with buttons_object and dead_man_bit"},
      {{"grip_bit = 0\ndead_man_bit = 1", "dead_man_bit = 0"}, "another bit than that of the grip"},
      {{"rated_torque_unit_Nm = 1e-6", "rated_torque_unit_Nm = 0.05"}, "a multiple of cia402.rated_torque_unit_Nm"},
      {{"writes =", "optional = \"0x1A01:01\"\nwrites ="}, "no PDO parameters"},
      {{"0x1800:03=0/2", "0x1800:03=0/3"}, "object=value/bytes"},
      {{"0x1800:03=0/2", "0x1800:03=70000/2"}, "object=value/bytes"},
      {{"0x1800:03=0/2", "0x1800:03"}, "object=value/bytes"},
      {{"0x1800:03=0/2", "0x6071:00=900/2"}, "no controlword, mode, set point, offset or output (0x6071:00)"},
      {{"0x1800:03=0/2", "0x6040:00=15/2"}, "(0x6040:00)"},
      {{"value = 4096", "value = 4097"}, "a multiple of cia402.counts_unit"},
  };
  for (const auto& [change, wanted] : bad) {
    const std::string told = with(change.first, change.second);
    EXPECT_NE(told.find(wanted), std::string::npos) << change.second << ": " << told;
    EXPECT_EQ(std::count(told.begin(), told.end(), '\n'), 0);
  }
  // The two that were taken above are checked together: our own word has fixed bits
  std::string text = shipped("epos4.toml");
  text.replace(text.find("\"inputs\""), 8, "\"ligature\"");
  text.replace(text.find("grip_bit = 0"), 12, "grip_bit = 5");
  const auto parsed = parse_device(text, "d.toml");
  ASSERT_TRUE(std::holds_alternative<scene::Error>(parsed));
  EXPECT_NE(std::get<scene::Error>(parsed).text.find("only with the 16 bits of docs/wire.md"), std::string::npos);
  // The same if the key `buttons` is not there: its default is our own word
  text.replace(text.find("buttons = \"ligature\""), 20, "");
  const auto without = parse_device(text, "d.toml");
  ASSERT_TRUE(std::holds_alternative<scene::Error>(without));
  EXPECT_NE(std::get<scene::Error>(without).text.find("cia402.source'"), std::string::npos);
}

TEST(OdriveRecord, IsOneOfTheTwoKindsOfDrive) {
  const auto parsed = parse_device(shipped("odrive.toml"), "odrive.toml");
  const Device& device = std::get<DeviceFile>(parsed).device;
  ASSERT_TRUE(device.odrive);
  EXPECT_EQ(device.odrive->buttons_id, 0x201U);
  EXPECT_EQ(device.odrive->watchdog, DriveWatchdog::kRpdoTimer);
  EXPECT_EQ(with("[feel]", "[odrive]\nsource = \"assumed\"\n[feel]").find("d.toml:"), 0U);
  EXPECT_NE(with("[feel]", "[odrive]\nsource = \"assumed\"\ntorque_constant_Nm_per_A = 0.1\n[feel]")
                .find("one of the tables [cia402] and [odrive]"),
            std::string::npos);
}

TEST(MoteusRecord, HasOneKindOfDriveAndNoGear) {
  const std::string good = shipped("moteus.toml");
  const auto parsed = parse_device(good, "moteus.toml");
  EXPECT_TRUE(std::get<DeviceFile>(parsed).device.moteus);
  EXPECT_FALSE(std::get<DeviceFile>(parsed).device.odrive);
  const auto refusal = [&](const std::string& old, const std::string& now) {
    std::string text = good;
    text.replace(text.find(old), old.size(), now);
    const auto other = parse_device(text, "d.toml");
    return std::holds_alternative<DeviceFile>(other) ? "" : std::get<scene::Error>(other).text;
  };
  EXPECT_NE(refusal("[feel]", "[odrive]\nsource = \"assumed\"\ntorque_constant_Nm_per_A = 0.1\n[feel]").find("one of"),
            std::string::npos);
  EXPECT_NE(refusal("[feel]", "[cia402]\nsource = \"assumed\"\n[feel]").find("d.toml:"), std::string::npos);
  EXPECT_NE(refusal("[0.98, 1.80, 1.25]", "[0.98, 1.80, 1.40]").find("less than half a turn"), std::string::npos)
      << "the third motor turns from -0.91 to 3.20";
  EXPECT_NE(refusal("gear = {value = 1.0", "gear = {value = 4.0").find("1 with [odrive] or [moteus]"),
            std::string::npos);
  EXPECT_NE(refusal("[0.98, 1.80, 1.25]", "[5.31, 1.80, 1.25]").find("less than one turn"), std::string::npos);
  EXPECT_NE(
      refusal("torque_tolerance_permille =", "# torque_tolerance_permille =").find("'torque_tolerance_permille' is"),
      std::string::npos)
      << "the torque is measured, and the default is for drives that tell it exactly";
}

/// An ODrive tells an angle within one turn of its motor.
TEST(OdriveRecord, RefusesWhatMakesTheAngleAmbiguous) {
  const std::string good = shipped("odrive.toml");
  const auto refusal = [&](const std::string& old, const std::string& now) {
    std::string text = good;
    text.replace(text.find(old), old.size(), now);
    const auto parsed = parse_device(text, "d.toml");
    return std::holds_alternative<DeviceFile>(parsed) ? "" : std::get<scene::Error>(parsed).text;
  };
  EXPECT_EQ(refusal("watchdog_ms = 20", "watchdog_ms = 30"), "");
  EXPECT_NE(refusal("heartbeat_ms = 10", "heartbeat_ms = 60").find("heartbeat_ms"), std::string::npos);
  EXPECT_NE(refusal("buttons_id = 0x201", "buttons_id = 0x7EE").find("buttons_id"), std::string::npos);
  EXPECT_NE(refusal("gear = {value = 1.0", "gear = {value = 4.0").find("1 with [odrive]"), std::string::npos);
  EXPECT_NE(refusal("[0.98, 1.80, 1.25]", "[0.98, 1.80, 3.60]").find("less than one turn"), std::string::npos)
      << "the third motor turns by 1.90 + 4.41";
  EXPECT_NE(refusal("[0.98, 1.80, 1.25]", "[5.31, 1.80, 1.25]").find("less than one turn"), std::string::npos);
  EXPECT_NE(refusal("torque_constant_Nm_per_A = 0.083", "").find("torque_constant"), std::string::npos);
}

}  // namespace
}  // namespace ligature::device
