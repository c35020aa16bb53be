// Compares the host's names for protocol numbers with the firmware's own lists; host code itself may not include
// firmware code.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>

#include "firmware/control/faults.hpp"
#include "firmware/control/state_machine.hpp"
#include "firmware/rt/tick_record.hpp"
#include "host/names.hpp"

namespace ligature::host {
namespace {

using Tick = ligature_msg::tick_t;

TEST(Names, StatesAreTheControllersOwn) {
  ASSERT_EQ(kStateNames.size(), static_cast<std::size_t>(control::kStates));
  for (std::int8_t s = 0; s < control::kStates; ++s)
    EXPECT_EQ(state_name(s), control::name(static_cast<control::State>(s)));
  EXPECT_EQ(state_name(control::kStates), "?");
  EXPECT_EQ(state_name(-1), "?");
}

TEST(Names, EveryFaultOfTheControllerIsExplainedAndNoOther) {
  std::set<int> known;
  for (int number = 1; number < 1000; ++number) {
    if (std::string(control::name(static_cast<control::Fault>(number))) != "unknown") known.insert(number);
  }
  std::set<int> explained;
  for (const auto& fault : kFaults) {
    explained.insert(fault.number);
    EXPECT_FALSE(fault.meaning.empty() || fault.remedy.empty()) << fault.number;
  }
  EXPECT_EQ(explained, known);
}

template <class List>
std::set<int> codes(const List& list) {
  std::set<int> found;
  for (const auto& entry : list) found.insert(entry.code);
  return found;
}

TEST(Names, EveryLimitAndDegradationHasOne) {
  EXPECT_EQ(codes(kLimitNames), (std::set<int>{rt::kPeakLimit, rt::kContinuousLimit, rt::kStepLimit, rt::kSlewLimit,
                                               rt::kVelocityBrake, rt::kPassivityLimit, rt::kTorqueLimit}));
  EXPECT_EQ(codes(kLimitNames),
            (std::set<int>{Tick::LIMIT_PEAK, Tick::LIMIT_CONTINUOUS, Tick::LIMIT_STEP, Tick::LIMIT_SLEW,
                           Tick::LIMIT_VELOCITY, Tick::LIMIT_PASSIVITY, Tick::LIMIT_TORQUE}));
  EXPECT_EQ(codes(kDegradationNames),
            (std::set<int>{static_cast<int>(rt::Degradation::kIterations), static_cast<int>(rt::Degradation::kContacts),
                           static_cast<int>(rt::Degradation::kCandidates)}));
}

TEST(Names, EveryConditionOfPropagationHasOne) {
  EXPECT_EQ(codes(kPropagationNames),
            (std::set<int>{static_cast<int>(rt::Propagation::kA), static_cast<int>(rt::Propagation::kB),
                           static_cast<int>(rt::Propagation::kC)}));
}

}  // namespace
}  // namespace ligature::host
