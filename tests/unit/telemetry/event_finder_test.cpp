// The events that are found in tick records.
#include "firmware/telemetry/event_finder.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "firmware/telemetry/in_words.hpp"
#include "ligature_msg/tick_t.hpp"

namespace ligature::telemetry {
namespace {

class EventFinderTest : public ::testing::Test {
 protected:
  void push(std::int64_t tick) {
    record.tick = tick;
    for (auto& event : finder.next(record)) events.push_back(std::move(event));
  }
  EventFinder finder{Names{[](int s) { return s == 0 ? "OFF" : "ON"; }, [](int) { return "broken"; }}};
  rt::TickRecord record;
  std::vector<ligature_msg::event_t> events;
};

TEST_F(EventFinderTest, ReadsThemOutOfTheRecords) {
  push(0);
  record.state = 6;
  record.fault = 11;
  record.grasped_node[1] = 17;
  record.flags = rt::kLeftLimited;
  push(1);
  record.flags = rt::kLeftLimited | rt::kPeriodLost;  // a lost period's record repeats held values, which give no event
  push(2);
  record.flags = 0;
  record.grasped_node[1] = -1;
  push(3);
  ASSERT_EQ(events.size(), 5U);
  using ligature_msg::event_t;
  const std::int8_t kinds[] = {event_t::KIND_FAULT, event_t::KIND_STATE, event_t::KIND_LIMIT, event_t::KIND_GRASP,
                               event_t::KIND_RELEASE};
  for (std::size_t i = 0; i < 5; ++i) EXPECT_EQ(events[i].kind, kinds[i]) << i;
  EXPECT_EQ(events[0].text, "fault 11: broken");
  EXPECT_EQ(events[0].hand, -1);
  EXPECT_EQ(events[3].code, 17);
  EXPECT_EQ(events[4].tick, 3);
}

TEST(InWords, NamesHandDriveAndError) {
  EXPECT_EQ(in_words(rt::Culprit{}), "");
  EXPECT_EQ(in_words(rt::Culprit{.hand = 1}), "right hand");
  EXPECT_EQ(in_words(rt::Culprit{0, 2, 0}), "left hand, forearm (node 3)");
  EXPECT_EQ(in_words(rt::Culprit{1, 3, 0}), "right hand, button module");
  EXPECT_EQ(in_words(rt::Culprit{0, 0, 0x3210}), "left hand, waist (node 1), error code 0x3210 (12816)");
}

TEST_F(EventFinderTest, AFaultNamesItsHandItsDriveAndTheDrivesError) {
  push(0);
  record.fault = 12;
  record.culprit = {1, 2, 0x3210};
  push(1);
  ASSERT_EQ(events.size(), 1U);
  EXPECT_EQ(events[0].text, "fault 12: broken, right hand, forearm (node 3), error code 0x3210 (12816)");
  EXPECT_EQ(events[0].hand, 1);
}

/// A rig that stays in OFF or CALIBRATE says why after 3 s, and then every 30 s; not if it leaves the state before.
TEST_F(EventFinderTest, ARigThatWaitsSaysWhatItWaitsFor) {
  record.culprit = {0, 1, 0};
  const auto until = [&](std::int64_t& tick, std::int64_t end) {
    for (; tick < end; ++tick) push(tick);
  };
  std::int64_t tick = 0;
  until(tick, 3000);
  EXPECT_TRUE(events.empty());
  until(tick, 32'999);
  ASSERT_EQ(events.size(), 1U);
  EXPECT_EQ(events[0].kind, ligature_msg::event_t::KIND_WAITS);
  EXPECT_EQ(events[0].tick, 3000);
  EXPECT_EQ(events[0].hand, 0);
  EXPECT_TRUE(events[0].text.ends_with(" for 3 s, waits for: left hand, shoulder (node 2)")) << events[0].text;
  record.state = ligature_msg::tick_t::STATE_CALIBRATE;
  record.culprit = {.hand = 1};
  until(tick, 40'000);
  ASSERT_EQ(events.size(), 3U) << "the change of state, and a word 3 s later";
  EXPECT_EQ(events[2].tick, 32'999 + 3000);
  EXPECT_EQ(events[2].code, ligature_msg::tick_t::STATE_CALIBRATE);
  EXPECT_TRUE(events[2].text.ends_with(" for 3 s, because the angles are no possible pose: right hand"))
      << events[2].text;
  until(tick, 70'000);
  EXPECT_EQ(events.size(), 4U) << "again after 30 s";
  record.state = ligature_msg::tick_t::STATE_IDLE;
  until(tick, 80'000);
  EXPECT_EQ(events.size(), 5U) << "in any other state nothing is waited for";
}

TEST_F(EventFinderTest, JawsThatCloseOnNothingAreAnEvent) {
  push(0);
  record.grip[1] = true;
  push(1);
  push(2);  // reported once
  record.grip[1] = false;
  push(3);
  record.grip[1] = true;
  record.grasped_node[1] = 3;
  push(4);
  ASSERT_EQ(events.size(), 2U);
  EXPECT_EQ(events[0].kind, ligature_msg::event_t::KIND_GRASP);
  EXPECT_EQ(events[0].code, -1);
  EXPECT_EQ(events[0].tick, 1);
  EXPECT_EQ(events[0].text, "right closes on nothing");
  EXPECT_EQ(events[1].code, 3);
}

/// An adaptive mesh renumbers its nodes while a hand holds one; that is neither a grasp nor a release.
TEST_F(EventFinderTest, ANodeNumberedAnewIsNoGrasp) {
  std::int64_t tick = 0;
  push(tick);
  record.grip[0] = true;
  for (const int node : {40, 41, 57, 3}) {
    record.grasped_node[0] = static_cast<std::int16_t>(node);
    push(++tick);
  }
  record.grip[0] = false;
  record.grasped_node[0] = -1;
  push(++tick);
  ASSERT_EQ(events.size(), 2U);
  EXPECT_EQ(events[0].text, "left grasps node 40");
  EXPECT_EQ(events[1].text, "left releases node 3");
}

}  // namespace
}  // namespace ligature::telemetry
