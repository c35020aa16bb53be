#include "host/exchange.hpp"

#include <gtest/gtest.h>

namespace ligature::host {
namespace {

using ligature_msg::command_t;
using Step = Exchange::Step;

ligature_msg::ack_t ack_of(std::int64_t id, std::int64_t session, std::int64_t challenge, bool accepted = false) {
  ligature_msg::ack_t ack{};
  ack.id = id;
  ack.session = session;
  ack.challenge = challenge;
  ack.accepted = accepted ? 1 : 0;
  return ack;
}

TEST(Exchange, AsksSaysAndIsAnswered) {
  Exchange arm(command_t::KIND_ARM, "words", 0.5);
  EXPECT_EQ(arm.message().session, 0);
  EXPECT_EQ(arm.message().challenge, 0);
  EXPECT_TRUE(arm.may_be_repeated());
  EXPECT_EQ(arm.take(ack_of(arm.id(), 42, 99)), Step::kSay);
  EXPECT_EQ(arm.message().session, 42);
  EXPECT_EQ(arm.message().challenge, 99);
  EXPECT_EQ(arm.message().kind, command_t::KIND_ARM);
  EXPECT_EQ(arm.message().text, "words");
  EXPECT_EQ(arm.message().value, 0.5);
  EXPECT_FALSE(arm.may_be_repeated()) << "doing it twice is not the same";
  EXPECT_EQ(arm.take(ack_of(arm.id(), 42, 0, true)), Step::kAnswered);
}

TEST(Exchange, AStopIsDoneAtOnceAndMayBeRepeated) {
  Exchange stop(command_t::KIND_STOP, "", 0.0);
  EXPECT_TRUE(stop.may_be_repeated());
  EXPECT_EQ(stop.take(ack_of(stop.id(), 42, 0, true)), Step::kAnswered);
}

/// Answers from a recording that is played back and from another firmware on the network are ignored.
TEST(Exchange, HearsOnlyTheAnswersThatAreMeant) {
  Exchange arm(command_t::KIND_ARM, "", 0.0);
  EXPECT_NE(arm.id(), Exchange(command_t::KIND_ARM, "", 0.0).id());
  EXPECT_EQ(arm.take(ack_of(arm.id() + 1, 42, 99)), Step::kWait);
  EXPECT_EQ(arm.take(ack_of(arm.id() + 1, 42, 0, true)), Step::kWait);
  EXPECT_EQ(arm.take(ack_of(arm.id(), 42, 99)), Step::kSay);
  EXPECT_EQ(arm.take(ack_of(arm.id(), 42, 98)), Step::kWait) << "the answer to a question that was repeated";
  EXPECT_EQ(arm.take(ack_of(arm.id(), 43, 97)), Step::kWait);
  EXPECT_EQ(arm.take(ack_of(arm.id(), 43, 0)), Step::kWait) << "another firmware refuses what is not for it";
  EXPECT_EQ(arm.message().challenge, 99);
  EXPECT_EQ(arm.take(ack_of(arm.id(), 42, 0)), Step::kAnswered) << "refused";
}

}  // namespace
}  // namespace ligature::host
