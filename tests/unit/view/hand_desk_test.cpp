#include "host/view/hand_desk.hpp"

#include <gtest/gtest.h>

namespace ligature::host::view {
namespace {

using nlohmann::json;
using namespace std::chrono_literals;

constexpr const char* kScene = R"([suture]
model = "paper-4"
nodes = 20
length_m = 1.0
radius_m = 0.01
[hands]
workspace_scale = 20.0
workspace_origin_m = [0.5, -0.4, 3.2]
)";
constexpr std::int64_t kSession = 77;

/// A desk that has received a scene and the state of a free left hand, 0.1 m above its home in the world.
struct HandsOnDesk {
  Access access{"0123456789abcdef", true};
  std::vector<ligature_msg::hand_wish_t> sent;
  HandDesk desk{access, [this](const auto& wish) { sent.push_back(wish); }};
  HandDesk::Clock::time_point now{};
  ligature_msg::hand_state_t state{};

  HandsOnDesk() {
    ligature_msg::status_t status{};
    status.scene_file = "test.toml";
    status.scene_toml = kScene;
    desk.take_status(status);
    state.session = kSession;
    state.p_home_m[2] = 0.005;
    state.grip = 1;
    hear();
  }
  void hear() { desk.take_state(state, now); }
  json ask(std::uint64_t page, json message) {
    message["token"] = access.token;
    message["id"] = 5;
    return desk.request(page, message, now);
  }
  json take(std::uint64_t page = 1) { return ask(page, {{"hand", "take"}, {"side", "left"}}); }
  json wish(std::uint64_t page, json p_W, bool dead = true) {
    return ask(page, {{"wish", {{"left", {{"p", std::move(p_W)}, {"dead", dead}, {"grip", false}}}}}});
  }
};

TEST(HandDesk, APageTakesAFreeHandWhereItIsAndWishesItElsewhere) {
  HandsOnDesk d;
  const json answer = d.take();
  EXPECT_EQ(answer["accepted"], true);
  EXPECT_EQ(answer["id"], 5);
  EXPECT_EQ(answer["page"], 1);
  EXPECT_EQ(answer["grip"], true);
  EXPECT_NEAR(answer["p_W"][2].get<double>(), 3.3, 1e-12);
  ASSERT_EQ(d.sent.size(), 1U);
  EXPECT_EQ(d.sent[0].session, kSession);
  EXPECT_NE(d.sent[0].owner, 0);
  EXPECT_EQ(d.sent[0].sequence, 1);
  EXPECT_EQ(d.sent[0].dead_man, 0);
  EXPECT_EQ(d.sent[0].grip, 1);
  EXPECT_EQ(d.sent[0].p_home_m[2], 0.005);

  EXPECT_TRUE(d.wish(1, {0.5, -0.2, 3.2}).is_null());
  ASSERT_EQ(d.sent.size(), 2U);
  EXPECT_EQ(d.sent[1].owner, d.sent[0].owner);
  EXPECT_EQ(d.sent[1].sequence, 2);
  EXPECT_EQ(d.sent[1].dead_man, 1);
  EXPECT_NEAR(d.sent[1].p_home_m[1], 0.01, 1e-12);
}

TEST(HandDesk, WithoutTheTokenNothingIsSent) {
  HandsOnDesk d;
  for (const char* token : {"", "x", "0123456789abcdeX"}) {
    const json answer = d.desk.request(1, {{"hand", "take"}, {"side", "left"}, {"id", 1}, {"token", token}}, d.now);
    EXPECT_EQ(answer["accepted"], false);
    EXPECT_NE(answer["text"].get<std::string>().find("token"), std::string::npos);
  }
  ASSERT_EQ(d.take()["accepted"], true);
  const auto before = d.sent.size();
  EXPECT_FALSE(d.desk.request(1, {{"wish", {{"left", {{"p", {0, 0, 0}}}}}}, {"token", "x"}}, d.now).is_null());
  EXPECT_EQ(d.sent.size(), before);
  const Access nobody{};
  const auto never = [](const auto&) { FAIL() << "a view that may only look sends nothing"; };
  HandDesk looks(nobody, never);
  looks.take_state(d.state, d.now);
  EXPECT_EQ(looks.request(1, {{"hand", "take"}, {"side", "left"}, {"token", ""}}, d.now)["accepted"], false);
}

TEST(HandDesk, AHandHasOnePage) {
  HandsOnDesk d;
  ASSERT_EQ(d.take(1)["accepted"], true);
  const json second = d.take(2);
  EXPECT_EQ(second["accepted"], false);
  EXPECT_EQ(second["text"], "somebody else has the left hand");
  const auto before = d.sent.size();
  EXPECT_TRUE(d.wish(2, {0.5, -0.4, 3.2}).is_null());
  EXPECT_EQ(d.sent.size(), before);
  EXPECT_EQ(d.ask(2, {{"hand", "leave"}, {"side", "left"}})["accepted"], false);
  EXPECT_EQ(d.ask(1, {{"hand", "leave"}, {"side", "left"}})["accepted"], true);
  EXPECT_EQ(d.sent.back().leaves, 1);
  EXPECT_EQ(d.sent.back().dead_man, 0);
  d.state.session = kSession + 1;
  d.hear();
  EXPECT_EQ(d.take(2)["accepted"], true);
}

TEST(HandDesk, AHandThatIsJustGivenBackIsFreeOnceItsDeviceSaysSo) {
  HandsOnDesk d;
  ASSERT_EQ(d.take(1)["accepted"], true);
  d.desk.end(1);
  // Two old states come late: one was sent before the hand was taken, the other before the device learned that the hand
  // was given back.
  for (const std::int64_t owner : {std::int64_t{0}, d.sent[0].owner}) {
    d.state.owner = owner;
    d.hear();
    EXPECT_EQ(d.desk.told(d.now)["left"]["free"], false);
    const json refusal = d.take(2);
    EXPECT_EQ(refusal["accepted"], false);
    EXPECT_EQ(refusal["soon"], true);
  }
  d.state.owner = 0;
  d.state.session = kSession + 1;
  d.hear();
  EXPECT_EQ(d.desk.told(d.now)["left"]["free"], true);
  EXPECT_EQ(d.take(2)["accepted"], true);
  EXPECT_EQ(d.sent.back().session, kSession + 1);
}

TEST(HandDesk, AHandWhoseDeviceHeardNothingOfItsPageIsFreeAfterAFewStates) {
  HandsOnDesk d;
  ASSERT_EQ(d.take(1)["accepted"], true);
  d.desk.end(1);
  for (int k = 0; k < 3; ++k) d.hear();
  EXPECT_EQ(d.take(2)["accepted"], true);
}

TEST(HandDesk, NoHandIsTakenThatDoesNotListenIsElsewhereOrHasNoScene) {
  HandsOnDesk d;
  EXPECT_NE(d.ask(1, {{"hand", "take"}, {"side", "right"}})["text"].get<std::string>().find("--operator page"),
            std::string::npos);
  d.state.owner = 99;
  d.hear();
  EXPECT_EQ(d.take()["text"], "somebody else has the left hand");
  d.state.owner = 0;
  d.hear();
  d.now += HandDesk::kDeafAfter + 1ms;
  EXPECT_EQ(d.take()["accepted"], false);
  d.hear();
  EXPECT_EQ(d.take()["accepted"], true);

  HandDesk sceneless(d.access, [](const auto&) { FAIL(); });
  sceneless.take_state(d.state, d.now);
  const json message{{"hand", "take"}, {"side", "left"}, {"token", d.access.token}};
  EXPECT_EQ(sceneless.request(1, message, d.now)["accepted"], false);
}

TEST(HandDesk, WhoseConnectionEndsGivesItsHandBackWithTheDeadManLetGo) {
  HandsOnDesk d;
  ASSERT_EQ(d.take(1)["accepted"], true);
  d.desk.end(2);
  EXPECT_EQ(d.sent.size(), 1U);
  d.desk.end(1);
  ASSERT_EQ(d.sent.size(), 2U);
  EXPECT_EQ(d.sent[1].leaves, 1);
  EXPECT_EQ(d.sent[1].dead_man, 0);
  d.desk.end(1);
  EXPECT_EQ(d.sent.size(), 2U);
}

TEST(HandDesk, TheDeviceSaysWhoHasTheHand) {
  HandsOnDesk d;
  ASSERT_EQ(d.take(1)["accepted"], true);
  d.hear();  // a state from before the first target was sent
  EXPECT_EQ(d.desk.told(d.now)["left"]["page"], 1);
  d.state.owner = d.sent[0].owner;
  d.hear();
  EXPECT_EQ(d.desk.told(d.now)["left"]["page"], 1);
  d.state.owner = d.sent[0].owner ^ 2;  // another view took the hand first
  d.hear();
  EXPECT_EQ(d.desk.told(d.now)["left"]["page"], 0);
  EXPECT_EQ(d.desk.told(d.now)["left"]["free"], false);
  const auto before = d.sent.size();
  EXPECT_TRUE(d.wish(1, {0.5, -0.4, 3.2}).is_null());
  EXPECT_EQ(d.sent.size(), before);
}

TEST(HandDesk, ASilenceThatEndedTheSessionTakesTheHandAway) {
  HandsOnDesk d;
  ASSERT_EQ(d.take(1)["accepted"], true);
  d.state.session = kSession + 1;
  d.hear();
  EXPECT_EQ(d.desk.told(d.now)["left"]["page"], 0);
  EXPECT_EQ(d.desk.told(d.now)["left"]["free"], true);
}

TEST(HandDesk, WhatIsNoPlaceIsNotWished) {
  HandsOnDesk d;
  ASSERT_EQ(d.take(1)["accepted"], true);
  const auto before = d.sent.size();
  for (const json& p : {json(), json("x"), json({1, 2}), json({1, 2, "3"}), json({1, 2, 3, 4}), json({1, 2, nullptr})})
    EXPECT_TRUE(d.wish(1, p).is_null()) << p;
  for (const json& wishes : {json(), json(3), json({{"left", 3}}), json({{"middle", {{"p", {0, 0, 0}}}}})})
    EXPECT_TRUE(d.ask(1, {{"wish", wishes}}).is_null()) << wishes;
  EXPECT_EQ(d.sent.size(), before);
  EXPECT_TRUE(d.wish(1, {1e300, 0.0, 0.0}).is_null());
  EXPECT_EQ(d.sent.back().p_home_m[0], 10.0);
  EXPECT_EQ(d.ask(1, {{"hand", "break"}, {"side", "left"}})["accepted"], false);
  EXPECT_EQ(d.ask(1, {{"hand", "take"}, {"side", "middle"}})["accepted"], false);
}

TEST(HandDesk, OnlyAWholeStateOfAHandInThisRoomIsOne) {
  const auto read = [](const ligature_msg::hand_state_t& state, std::size_t left_out = 0) {
    std::vector<std::byte> bytes;
    encode(state, bytes);
    return hand_state_of(Bytes(bytes).first(bytes.size() - left_out));
  };
  ligature_msg::hand_state_t state{};
  state.hand = 1;
  EXPECT_TRUE(read(state));
  EXPECT_FALSE(read(state, 1));
  for (const double x : {11.0, -1e300, std::numeric_limits<double>::quiet_NaN()}) {
    state.p_home_m[1] = x;
    EXPECT_FALSE(read(state)) << x;
  }
  state.p_home_m[1] = 0.0;
  state.hand = 2;
  EXPECT_FALSE(read(state));
}

}  // namespace
}  // namespace ligature::host::view
