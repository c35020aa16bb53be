// CommandGate distinguishes new commands from those that a replayed recording repeats.
#include "firmware/telemetry/command_gate.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "protocol/lcm/command_words.hpp"

namespace ligature::telemetry {
namespace {

using ligature_msg::command_t;

class CommandGateTest : public ::testing::Test {
 protected:
  static constexpr std::int64_t kSession = 42, kLater_us = 1'000;

  command_t command(std::int8_t kind, std::int64_t id = 7) const {
    command_t c{};
    c.kind = kind;
    c.id = id;
    return c;
  }
  /// Gives the gate a new command, which the gate answers with a challenge. @return the command with that challenge, as
  /// its sender repeats it.
  command_t asked(command_t c, std::int64_t at_us = 0) {
    const auto judged = gate.judge(c, at_us);
    EXPECT_FALSE(judged.may_be_done);
    EXPECT_NE(judged.challenge, 0);
    c.session = kSession;
    c.challenge = judged.challenge;
    return c;
  }
  CommandGate gate{kSession};
};

TEST_F(CommandGateTest, EveryKindButStopAndDisarmIsDoneOnlyWithItsChallengeAndOnce) {
  for (const auto& [kind, word] : lcm_tools::kCommandWords) {
    if (kind == command_t::KIND_STOP || kind == command_t::KIND_DISARM) continue;
    const auto said = asked(command(kind));
    EXPECT_TRUE(gate.judge(said, kLater_us).may_be_done) << word;
    const auto again = gate.judge(said, kLater_us);
    EXPECT_FALSE(again.may_be_done) << word;
    EXPECT_NE(again.why.find("session 42 replayed"), std::string::npos) << again.why;
  }
}

/// Commands that remove force are never refused; repeating them is harmless.
TEST_F(CommandGateTest, StopAndDisarmAreDoneWhoeverSaysThemAndWhenever) {
  for (const auto kind : {command_t::KIND_STOP, command_t::KIND_DISARM}) {
    for (const std::int64_t session : {std::int64_t{0}, kSession, std::int64_t{17}}) {
      for (const std::int64_t challenge : {0, 99}) {
        auto c = command(kind);
        c.session = session;
        c.challenge = challenge;
        for (int i = 0; i < 3; ++i) EXPECT_TRUE(gate.judge(c, i * 1'000'000'000LL).may_be_done);
      }
    }
  }
}

TEST_F(CommandGateTest, ARecordingOfAnEarlierRunIsNamedAndRefused) {
  const auto recorded = asked(command(command_t::KIND_ARM));
  ASSERT_TRUE(gate.judge(recorded, kLater_us).may_be_done);
  CommandGate next_run(43);
  const auto judged = next_run.judge(recorded, kLater_us);
  EXPECT_FALSE(judged.may_be_done);
  EXPECT_EQ(judged.why,
            "command of session 42, this is session 43: played back from a recording, or meant for another rig");
  auto question = recorded;
  question.challenge = 0;  // the first message of the other run's sender, which asks for a challenge, gets none either
  EXPECT_EQ(next_run.judge(question, kLater_us).challenge, 0);
}

TEST_F(CommandGateTest, AChallengeIsGoodForItsSendersIdAndKindOnly) {
  auto other_id = asked(command(command_t::KIND_RESET_THREAD));
  other_id.id = 8;
  EXPECT_FALSE(gate.judge(other_id, kLater_us).may_be_done);
  auto other_kind = asked(command(command_t::KIND_RESET_THREAD));
  other_kind.kind = command_t::KIND_ARM;
  EXPECT_FALSE(gate.judge(other_kind, kLater_us).may_be_done);
  auto none = command(command_t::KIND_ARM);
  none.session = kSession;
  none.challenge = 1;
  EXPECT_FALSE(gate.judge(none, kLater_us).may_be_done);
}

TEST_F(CommandGateTest, AChallengeIsGoodForTwoSecondsOfTheMonotonicClock) {
  constexpr std::int64_t kBegin = 5'000'000;
  const auto in_time = asked(command(command_t::KIND_ARM), kBegin);
  EXPECT_TRUE(gate.judge(in_time, kBegin + CommandGate::kLongest_us).may_be_done);
  const auto late = asked(command(command_t::KIND_ARM), kBegin);
  EXPECT_FALSE(gate.judge(late, kBegin + CommandGate::kLongest_us + 1).may_be_done);
}

TEST_F(CommandGateTest, MayBeAskedWithoutEndAndKeepsTheNewestChallenges) {
  std::vector<command_t> said;
  constexpr std::size_t kMany = 10 * CommandGate::kMostOpen;
  for (std::size_t i = 0; i < kMany; ++i) said.push_back(asked(command(command_t::KIND_ARM, static_cast<int>(i))));
  std::size_t done = 0;
  for (const auto& c : said) done += gate.judge(c, kLater_us).may_be_done ? 1 : 0;
  EXPECT_EQ(done, CommandGate::kMostOpen);
}

TEST_F(CommandGateTest, NoTwoChallengesAreAlikeAndNoneIsZero) {
  std::int64_t next = 0;
  CommandGate counting(kSession, [&] { return next++; });  // a challenge of zero would mean "none" and must be skipped
  EXPECT_EQ(counting.judge(command(command_t::KIND_ARM), 0).challenge, 1);
  CommandGate other_run(kSession);  // for example with the same wall-clock time at the start
  EXPECT_NE(asked(command(command_t::KIND_ARM)).challenge, other_run.judge(command(command_t::KIND_ARM), 0).challenge);
}

TEST(CommandWords, AreThoseOfTheMessage) {
  EXPECT_EQ(lcm_tools::command_kind("arm"), command_t::KIND_ARM);
  EXPECT_EQ(lcm_tools::command_kind("disarm"), command_t::KIND_DISARM);
  EXPECT_EQ(lcm_tools::command_kind("stop"), command_t::KIND_STOP);
  EXPECT_EQ(lcm_tools::command_kind("reset-fault"), command_t::KIND_RESET_FAULT);
  EXPECT_EQ(lcm_tools::command_kind("reset-thread"), command_t::KIND_RESET_THREAD);
  EXPECT_EQ(lcm_tools::command_kind("load-scene"), command_t::KIND_LOAD_SCENE);
  EXPECT_EQ(lcm_tools::command_kind("set"), command_t::KIND_SET_PARAMETER);
  EXPECT_EQ(lcm_tools::command_kind("clutch left"), command_t::KIND_CLUTCH_LEFT);
  EXPECT_EQ(lcm_tools::command_kind("unclutch left"), command_t::KIND_UNCLUTCH_LEFT);
  EXPECT_EQ(lcm_tools::command_kind("clutch right"), command_t::KIND_CLUTCH_RIGHT);
  EXPECT_EQ(lcm_tools::command_kind("unclutch right"), command_t::KIND_UNCLUTCH_RIGHT);
  EXPECT_EQ(lcm_tools::command_kind("park"), command_t::KIND_PARK);
  EXPECT_EQ(lcm_tools::command_kind("calibrate"), command_t::KIND_CALIBRATE);
  EXPECT_FALSE(lcm_tools::command_kind("clutch"));
  EXPECT_EQ(lcm_tools::command_word(command_t::KIND_PARK), "park");
  EXPECT_EQ(lcm_tools::command_word(-8), "command -8");
}

}  // namespace
}  // namespace ligature::telemetry
