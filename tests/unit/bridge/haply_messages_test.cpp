// The messages of Haply's Inverse Service, as its documentation shows them.
#include "bridge/haply_messages.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "protocol/can/device_profile.hpp"
#include "tests/support/random.hpp"

namespace ligature::bridge {
namespace {

constexpr const char* kFirst = R"({"session_id":7,"inverse3":[{"device_id":"04BA","config":{"type":"inverse3"},
 "state":{"angular_position":{"a0":-69.3},"cursor_position":{"x":0.07842738,"y":-0.14836666,"z":0.14297646},"mode":"idle"},
 "status":{"calibrated":true,"in_use":false,"power_supply":true,"ready":true,"started":true}}],
 "wireless_verse_grip":[{"device_id":"61548","state":{"buttons":{"a":true,"b":false,"c":true},"hall":0}}]})";

std::string state(const std::string& grip, const std::string& id = "04BA") {
  return R"({"inverse3":[{"device_id":")" + id + R"(","state":{"cursor_position":{"x":1,"y":2,"z":3}}}])" + grip + "}";
}

TEST(HaplyMessages, TheFirstMessageTellsDevicePositionAndButtons) {
  HaplyState before;
  const auto read = read_haply(kFirst, {}, before);
  ASSERT_TRUE(read);
  EXPECT_EQ(read->inverse3_id, "04BA");
  EXPECT_EQ(read->problem, "");
  EXPECT_EQ(read->state.p_D_m, (Vec{0.07842738, -0.14836666, 0.14297646}));
  EXPECT_EQ(read->state.buttons, can::profile::kButtonDeadMan | can::profile::kButtonClutch);
}

TEST(HaplyMessages, AGripThatIsNotThereHoldsNoButton) {
  HaplyState before;
  ASSERT_TRUE(read_haply(kFirst, {}, before));
  for (const char* grip : {"", R"(,"wireless_verse_grip":[])", R"(,"wireless_verse_grip":[{"device_id":"61548"}])",
                           R"(,"wireless_verse_grip":[{"device_id":"61548","state":{"buttons":{"a":1,"b":"true"}}}])",
                           R"(,"wireless_verse_grip":[{"device_id":"other","state":{"buttons":{"a":true}}}])"}) {
    HaplyChoice choice;
    choice.grip_id = "61548";
    const auto read = read_haply(state(grip), choice, before);
    ASSERT_TRUE(read) << grip;
    EXPECT_EQ(read->state.buttons, 0) << grip;
  }
}

/// The service lists the grips of both hands to every client, so the first grip in the list may be that of the other
/// hand.
TEST(HaplyMessages, OneOfSeveralGripsMustBeNamed) {
  const char* const both = R"(,"wireless_verse_grip":[{"device_id":"1","state":{"buttons":{"a":true}}}],
   "verse_grip":[{"device_id":"2","state":{"buttons":{"a":false}}}])";
  HaplyState before;
  const auto read = read_haply(state(both), {}, before);
  ASSERT_TRUE(read);
  EXPECT_EQ(read->problem, "several grips are connected; remedy: --grip-id");
  EXPECT_EQ(read->state.buttons, 0);
  const char* const one = R"(,"wireless_verse_grip":[{"device_id":"1","state":{"buttons":{"a":true}}}])";
  EXPECT_NE(read_haply(state(one), {}, before)->problem, "") << "the other one sent nothing new";
  HaplyState other;
  const char* const custom = R"(,"wireless_verse_grip":[{"device_id":"1","state":{"buttons":{"a":true}}}],
   "custom_verse_grip":[{"device_id":"8"}])";
  EXPECT_EQ(read_haply(state(custom), {}, other)->state.buttons, 0);
  HaplyChoice choice;
  choice.grip_id = "1";
  HaplyState named;
  EXPECT_EQ(read_haply(state(both), choice, named)->state.buttons, can::profile::kButtonDeadMan);
  EXPECT_EQ(named.problem, "");
}

TEST(HaplyMessages, AGripThatSleepsHoldsNoButton) {
  const std::string held = R"("state":{"buttons":{"a":true}})", grip = R"(,"verse_grip":[{"device_id":"1",)";
  HaplyState before;
  EXPECT_EQ(read_haply(state(grip + held + "}]"), {}, before)->state.buttons, can::profile::kButtonDeadMan);
  for (const char* fact : {"connected", "awake", "ready"}) {
    const std::string word = R"("status":{")" + std::string(fact) + R"(":)";
    EXPECT_EQ(read_haply(state(grip + word + "false}," + held + "}]"), {}, before)->state.buttons, 0) << fact;
    EXPECT_EQ(read_haply(state(grip + held + "}]"), {}, before)->state.buttons, 0) << fact << " is not repeated";
    EXPECT_NE(read_haply(state(grip + word + "true}," + held + "}]"), {}, before)->state.buttons, 0) << fact;
  }
}

TEST(HaplyMessages, OnlyTheChosenDeviceIsRead) {
  HaplyChoice choice;
  choice.inverse3_id = "04BB";
  HaplyState before;
  EXPECT_FALSE(read_haply(state(""), choice, before));
  EXPECT_TRUE(read_haply(state("", "04BB"), choice, before));
}

TEST(HaplyMessages, AStatusStaysUntilAnotherComes) {
  HaplyState before;
  std::string text = kFirst;
  text.replace(text.find(R"("calibrated":true)"), 17, R"("calibrated":false)");
  EXPECT_EQ(read_haply(text, {}, before)->problem, "not calibrated");
  EXPECT_EQ(read_haply(state(""), {}, before)->problem, "not calibrated");
  EXPECT_EQ(read_haply(kFirst, {}, before)->problem, "");
}

TEST(HaplyMessages, DamagedMessagesAreNoState) {
  const std::string whole = kFirst;
  HaplyState before;
  for (std::size_t cut = 0; cut < whole.size(); ++cut)
    EXPECT_FALSE(read_haply(whole.substr(0, cut), {}, before)) << cut;
  for (const char* bad :
       {"[]", "7", "null", R"({"inverse3":{}})", R"({"inverse3":[7]})", R"({"inverse3":[{"device_id":7}]})",
        R"({"inverse3":[{"device_id":"a","state":{"cursor_position":{"x":1,"y":2}}}]})",
        R"({"inverse3":[{"device_id":"a","state":{"cursor_position":{"x":1,"y":2,"z":"3"}}}]})",
        R"({"inverse3":[{"device_id":"a","state":{"cursor_position":{"x":1,"y":2,"z":1e999}}}]})"})
    EXPECT_FALSE(read_haply(bad, {}, before)) << bad;
}

TEST(HaplyMessages, ChangedBytesNeverCrash) {
  test::Random random(1);
  HaplyState before;
  for (int round = 0; round < 3000; ++round) {
    std::string text = kFirst;
    for (int i = 0; i < 4; ++i) text[random.below(text.size())] = static_cast<char>(random.below(256));
    const auto read = read_haply(text, {}, before);
    if (!read) continue;
    for (const double x : read->state.p_D_m) EXPECT_TRUE(std::isfinite(x));
  }
}

TEST(HaplyMessages, ACommandIsOneForceForOneDevice) {
  const auto first = nlohmann::json::parse(haply_command("04BA", {0.5, -1.0, 2.0}, true));
  EXPECT_EQ(first.at("session").at("configure").at("profile").at("name"), "ligature-bridge");
  const auto later = nlohmann::json::parse(haply_command("04BA", {0.5, -1.0, 2.0}, false));
  EXPECT_FALSE(later.contains("session"));
  const auto& device = later.at("inverse3").at(0);
  EXPECT_EQ(device.at("device_id"), "04BA");
  EXPECT_EQ(device.at("commands").at("set_cursor_force").at("vector"),
            (nlohmann::json{{"x", 0.5}, {"y", -1.0}, {"z", 2.0}}));
}

}  // namespace
}  // namespace ligature::bridge
