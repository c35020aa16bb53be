#include "protocol/can/cia402.hpp"

#include <gtest/gtest.h>

#include <set>

namespace ligature::can::cia402 {
namespace {

constexpr int kStates = static_cast<int>(State::kFault) + 1;
constexpr int kEvents = static_cast<int>(Event::kFaultReactionDone) + 1;

TEST(Cia402, EveryStatuswordShowsAtMostOneState) {
  for (int word = 0; word <= 0xFFFF; ++word) {
    int matches = 0;
    for (const StatusPattern& p : kStatusPatterns) matches += (word & p.mask) == p.value ? 1 : 0;
    EXPECT_LE(matches, 1) << word;
  }
}

TEST(Cia402, BitsOutsideThePatternDoNotChangeTheState) {
  const unsigned outside = kVoltageEnabledBit | kRemoteBit | kInternalLimitBit | kFollowsTargetBit;
  for (int s = 0; s < kStates; ++s) {
    const auto state = static_cast<State>(s);
    EXPECT_EQ(state_of(static_cast<std::uint16_t>(statusword_of(state) | outside)), state);
  }
}

TEST(Cia402, NoPairIsListedTwice) {
  std::set<std::pair<State, Event>> seen;
  for (const Transition& t : kTransitions) EXPECT_TRUE(seen.insert({t.from, t.on}).second);
}

TEST(Cia402, OperationIsEnteredOnlyFromSwitchedOnByEnableOperation) {
  for (int s = 0; s < kStates; ++s) {
    for (int e = 0; e < kEvents; ++e) {
      const auto from = static_cast<State>(s);
      const auto on = static_cast<Event>(e);
      if (from == State::kOperationEnabled || next(from, on) != State::kOperationEnabled) continue;
      EXPECT_EQ(from, State::kSwitchedOn);
      EXPECT_EQ(on, Event::kEnableOperation);
    }
  }
}

TEST(Cia402, AFaultIsLeftOnlyByTheRisingEdgeOfFaultReset) {
  for (int word = 0; word <= 0xFF; ++word) {
    const auto w = static_cast<std::uint16_t>(word);
    const auto held = event_of(kControlFaultReset, w);  // bit 7 was set before, so there is no rising edge
    EXPECT_TRUE(!held || next(State::kFault, *held) == State::kFault) << word;
    const auto risen = event_of(0, w);
    const bool resets = risen && next(State::kFault, *risen) != State::kFault;
    EXPECT_EQ(resets, (w & kControlFaultReset) != 0) << word;
  }
}

TEST(Cia402, AFaultIsReachedFromEveryState) {
  for (int s = 0; s < kStates; ++s) {
    EXPECT_EQ(next(next(static_cast<State>(s), Event::kFaultDetected), Event::kFaultReactionDone), State::kFault);
  }
}

TEST(Cia402, MastersWordsNeverResetAFault) {
  for (int s = 0; s < kStates; ++s)
    EXPECT_EQ(controlword_towards_operation(static_cast<State>(s)) & kControlFaultReset, 0);
}

}  // namespace
}  // namespace ligature::can::cia402
