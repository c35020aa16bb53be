#include "host/stream/live_topics.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "../host/synthetic_log.hpp"
#include "host/errors.hpp"
#include "host/stream/udp_sender.hpp"

namespace ligature::host::stream {
namespace {

using Json = nlohmann::json;
constexpr std::int64_t kSession_us = 1'800'000'000'000'000;

template <class M>
std::vector<TopicMessage> sent_by(LiveTopics& topics, std::string_view channel, const M& message) {
  const auto bytes = test::encoded(message);
  return topics.take({0, channel, bytes});
}

ligature_msg::status_t status_of(std::int64_t session) {
  ligature_msg::status_t status{};
  status.session = session;
  status.period_s = 4e-3;
  return status;
}

TEST(LiveTopics, TicksAreEvenlySpacedFromTheStartOfTheFirmware) {
  LiveTopics topics;
  EXPECT_TRUE(sent_by(topics, kTicksChannel, test::batch_of(kSession_us, 100, 2)).empty());  // period not known yet
  EXPECT_TRUE(sent_by(topics, kStatusChannel, status_of(kSession_us)).empty());
  const auto sent = sent_by(topics, kTicksChannel, test::batch_of(kSession_us, 100, 2));
  ASSERT_EQ(sent.size(), 6U);
  for (std::size_t i = 0; i < sent.size(); ++i) {
    EXPECT_EQ(sent[i].topic, i % 3);
    EXPECT_EQ(sent[i].time_ns, static_cast<std::uint64_t>(kSession_us) * 1000 + (100 + i / 3) * 4'000'000);
  }
  EXPECT_EQ(Json::parse(sent[3].text).at("tick"), 101);
}

TEST(LiveTopics, TicksOfAnotherRunAreLeftOut) {
  LiveTopics topics;
  (void)sent_by(topics, kStatusChannel, status_of(kSession_us));
  EXPECT_TRUE(sent_by(topics, kTicksChannel, test::batch_of(kSession_us + 1, 0, 2)).empty());
  (void)sent_by(topics, kStatusChannel, status_of(kSession_us + 1));
  const auto sent = sent_by(topics, kTicksChannel, test::batch_of(kSession_us + 1, 0, 1));
  ASSERT_EQ(sent.size(), 3U);
  EXPECT_EQ(Json::parse(sent[0].text).at("session"), 2);
}

TEST(LiveTopics, ShapesAndEventsHaveTheTimeOfTheirTick) {
  LiveTopics topics;
  (void)sent_by(topics, kStatusChannel, status_of(kSession_us));
  const auto shapes = sent_by(topics, kThreadChannel, test::thread_of(250, test::straight_points(5)));
  ASSERT_EQ(shapes.size(), 1U);
  EXPECT_EQ(shapes[0].time_ns, static_cast<std::uint64_t>(kSession_us) * 1000 + 1'000'000'000);
  const Json entity = Json::parse(shapes[0].text).at("entities")[0];
  EXPECT_EQ(entity.at("timestamp").at("sec"), kSession_us / 1'000'000 + 1);
  EXPECT_EQ(entity.at("lines")[0].at("points").size(), 5U);
  ligature_msg::event_t event{};
  event.tick = 1;
  event.text = "grasp \xff";  // no valid text: replaced, not refused
  const auto events = sent_by(topics, kEventChannel, event);
  ASSERT_EQ(events.size(), 1U);
  EXPECT_TRUE(Json::parse(events[0].text).at("text").get<std::string>().starts_with("grasp "));
}

TEST(LiveTopics, WhatCannotBeReadIsLeftOut) {
  LiveTopics topics;
  (void)sent_by(topics, kStatusChannel, status_of(kSession_us));
  const std::vector<std::byte> noise(40, std::byte{0x55});
  for (const auto channel : {kStatusChannel, kTicksChannel, kThreadChannel, kEventChannel, kAckChannel})
    EXPECT_TRUE(topics.take({0, channel, noise}).empty()) << channel;
}

TEST(UdpSender, ADatagramIsOneJsonObjectWithTheTickAndItsTime) {
  const Json one =
      Json::parse(tick_datagram({0, 5'000'000'007, R"({"a":1})"}, {1, 0, R"({"b":2})"}, {2, 0, R"({"c":3})"}));
  EXPECT_EQ(one.at("timestamp").get<double>(), 5.000000007);
  EXPECT_EQ(one.at("rig").at("a"), 1);
  EXPECT_EQ(one.at("left").at("b"), 2);
  EXPECT_EQ(one.at("right").at("c"), 3);
}

TEST(UdpSender, RefusesWhatIsNoAddressWithPort) {
  for (const char* target : {"", "127.0.0.1", "127.0.0.1:", "127.0.0.1:0", "127.0.0.1:70000", "host:1x", ":9870"})
    EXPECT_THROW(UdpSender{target}, BadInput) << target;
}

}  // namespace
}  // namespace ligature::host::stream
