#include "host/view/command_desk.hpp"

#include <gtest/gtest.h>

namespace ligature::host::view {
namespace {

using nlohmann::json;
using namespace std::chrono_literals;

/// A desk that collects its commands in a list; the test sets its clock.
struct Desk {
  Access access{"0123456789abcdef", true};
  std::vector<ligature_msg::command_t> sent;
  CommandDesk desk{access, [this](const auto& command) { sent.push_back(command); }};
  CommandDesk::Clock::time_point now{};

  json ask(json message) { return desk.request(1, message, now); }
  json stop() { return ask({{"command", "stop"}, {"id", 5}, {"token", access.token}}); }
  void acknowledge(bool accepted, const std::string& why) {
    ligature_msg::ack_t ack{};
    ack.id = sent.back().id;
    ack.accepted = accepted ? 1 : 0;
    ack.reason = why;
    desk.take_ack(ack);
  }
};

TEST(CommandDesk, PassesTextAndValueOnAndWaitsLongerForWhatIsMeasuredFirst) {
  Desk d;
  EXPECT_TRUE(
      d.ask({{"command", "set"}, {"text", "contact.friction"}, {"value", 0.5}, {"id", 1}, {"token", d.access.token}})
          .is_null());
  EXPECT_TRUE(d.ask({{"command", "load-scene"},
                     {"text", std::string(5000, 'x')},
                     {"value", "nonsense"},
                     {"id", 2},
                     {"token", d.access.token}})
                  .is_null());
  ASSERT_EQ(d.sent.size(), 2U);
  EXPECT_EQ(d.sent[0].kind, ligature_msg::command_t::KIND_SET_PARAMETER);
  EXPECT_EQ(d.sent[0].text, "contact.friction");
  EXPECT_EQ(d.sent[0].value, 0.5);
  EXPECT_EQ(d.sent[1].text.size(), 100U);
  EXPECT_TRUE(d.desk.answers(d.now + 9s).empty());
  EXPECT_EQ(d.desk.answers(d.now + 10s).size(), 2U);
}

TEST(CommandDesk, PassesACommandOnAndItsAnswerBack) {
  Desk d;
  EXPECT_TRUE(d.ask({{"command", "arm"}, {"id", 7}, {"token", d.access.token}}).is_null());
  ASSERT_EQ(d.sent.size(), 1U);
  EXPECT_EQ(d.sent[0].kind, ligature_msg::command_t::KIND_ARM);
  EXPECT_TRUE(d.desk.answers(d.now).empty());
  d.acknowledge(false, "fault 11 is latched");
  const auto answers = d.desk.answers(d.now);
  ASSERT_EQ(answers.size(), 1U);
  EXPECT_EQ(answers.begin()->first, 1U);
  EXPECT_EQ(answers.begin()->second,
            (json{{"id", 7}, {"command", "arm"}, {"accepted", false}, {"text", "fault 11 is latched"}}));
}

TEST(CommandDesk, SaysACommandAgainWithTheChallengeThatItIsGivenAndOnceOnly) {
  Desk d;
  EXPECT_TRUE(d.ask({{"command", "arm"}, {"id", 7}, {"token", d.access.token}}).is_null());
  (void)d.desk.answers(d.now + 100ms);
  ASSERT_EQ(d.sent.size(), 2U) << "asking again does no harm";
  ligature_msg::ack_t ack{};
  ack.id = d.sent[0].id;
  ack.session = 42;
  ack.challenge = 99;
  d.desk.take_ack(ack);
  ASSERT_EQ(d.sent.size(), 3U);
  EXPECT_EQ(d.sent[2].id, d.sent[0].id);
  EXPECT_EQ(d.sent[2].session, 42);
  EXPECT_EQ(d.sent[2].challenge, 99);
  EXPECT_TRUE(d.desk.answers(d.now + 300ms).empty());
  d.desk.take_ack(ack);
  EXPECT_EQ(d.sent.size(), 3U);
  ack.challenge = 0;
  ack.accepted = 1;
  d.desk.take_ack(ack);
  EXPECT_EQ(d.desk.answers(d.now + 300ms).begin()->second["accepted"], true);
}

TEST(CommandDesk, WithoutTheTokenNothingIsSent) {
  Desk d;
  for (const json& message : {json{{"command", "arm"}, {"id", 1}}, json{{"command", "arm"}, {"token", "wrong"}},
                              json{{"command", "arm"}, {"token", 7}}, json{{"command", 3}}, json::object()})
    EXPECT_EQ(d.ask(message)["accepted"], false) << message;
  d.access.token.clear();
  EXPECT_EQ(d.ask({{"command", "arm"}, {"token", ""}})["accepted"], false);
  EXPECT_TRUE(d.sent.empty());
}

TEST(CommandDesk, SaysThatNobodyAnswered) {
  Desk d;
  EXPECT_TRUE(d.ask({{"command", "disarm"}, {"id", 1}, {"token", d.access.token}}).is_null());
  EXPECT_TRUE(d.desk.answers(d.now + 999ms).empty());
  const auto answers = d.desk.answers(d.now + 1s);
  ASSERT_EQ(answers.size(), 1U);
  EXPECT_EQ(answers.begin()->second["accepted"], false);
}

TEST(CommandDesk, RepeatsAStopUntilItIsHeard) {
  Desk d;
  EXPECT_TRUE(d.stop().is_null());
  (void)d.desk.answers(d.now + 100ms);
  (void)d.desk.answers(d.now + 150ms);
  (void)d.desk.answers(d.now + 200ms);
  EXPECT_EQ(d.sent.size(), 3U);
  EXPECT_EQ(d.sent[0].id, d.sent[2].id);
  d.acknowledge(true, "");
  (void)d.desk.answers(d.now + 300ms);
  EXPECT_EQ(d.sent.size(), 3U);
}

TEST(CommandDesk, HoldsABoundedNumber) {
  Desk d;
  json last;
  for (std::size_t i = 0; i <= CommandDesk::kMostWaiting; ++i) last = d.stop();
  EXPECT_EQ(last["accepted"], false);
  EXPECT_EQ(d.sent.size(), CommandDesk::kMostWaiting);
}

}  // namespace
}  // namespace ligature::host::view
