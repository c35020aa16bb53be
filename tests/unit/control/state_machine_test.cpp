// static_asserts beside the transition table prove its rules; these tests take typical paths through the states.
#include "firmware/control/state_machine.hpp"

#include <gtest/gtest.h>

#include <string>

#include "firmware/control/faults.hpp"

namespace ligature::control {
namespace {

TEST(StateMachine, WalksFromOffToForceAndBack) {
  State s = State::kOff;
  for (const Event e : {Event::kDrivesUp, Event::kCalibrated, Event::kArm, Event::kEngaged}) s = next(s, e);
  EXPECT_EQ(s, State::kForce);
  for (const Event e : {Event::kDisarm, Event::kStopped, Event::kPowerDown}) s = next(s, e);
  EXPECT_EQ(s, State::kOff);
}

TEST(StateMachine, ArmingIsHeardInIdleOnly) {
  for (int s = 0; s < kStates; ++s) {
    const auto from = static_cast<State>(s);
    EXPECT_EQ(next(from, Event::kArm), from == State::kIdle ? State::kEngage : from);
  }
}

TEST(StateMachine, EveryStateCanBeReached) {
  for (int s = 0; s < kStates; ++s) {
    bool reached = static_cast<State>(s) == State::kOff || static_cast<State>(s) == State::kFault;
    for (const Transition& t : kTransitions) reached = reached || t.to == static_cast<State>(s);
    EXPECT_TRUE(reached) << name(static_cast<State>(s));
  }
}

TEST(Faults, NumbersAreFixedAndNamed) {
  EXPECT_EQ(static_cast<int>(Fault::kBusLost), 10);
  EXPECT_EQ(static_cast<int>(Fault::kTpdoTooOld), 11);
  EXPECT_EQ(static_cast<int>(Fault::kDriveFault), 12);
  EXPECT_EQ(static_cast<int>(Fault::kNonFinite), 20);
  EXPECT_EQ(static_cast<int>(Fault::kVelocityLimit), 21);
  EXPECT_EQ(static_cast<int>(Fault::kOverrun), 30);
  EXPECT_EQ(static_cast<int>(Fault::kPhysicsDiverged), 40);
  EXPECT_NE(std::string(name(Fault::kOverrun)), "unknown");
}

}  // namespace
}  // namespace ligature::control
