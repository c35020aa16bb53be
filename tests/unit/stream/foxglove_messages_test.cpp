#include "host/stream/foxglove_messages.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "host/viewer_topics.hpp"

namespace ligature::host::stream {
namespace {

using Json = nlohmann::json;

TEST(Foxglove, TheSubprotocolIsFoundAmongOthers) {
  EXPECT_TRUE(offers_foxglove("foxglove.websocket.v1"));
  EXPECT_TRUE(offers_foxglove("foxglove.sdk.v1, foxglove.websocket.v1"));
  EXPECT_TRUE(offers_foxglove(" foxglove.websocket.v1 ,x"));
  for (const char* other :
       {"", ",", " , ", "foxglove.websocket.v2", "xfoxglove.websocket.v1", "foxglove.websocket.v1x"})
    EXPECT_FALSE(offers_foxglove(other)) << other;
}

TEST(Foxglove, OtherWebSitesMayNotRead) {
  for (const char* good : {"", "https://app.foxglove.dev", "file://", "app://foxglove"})
    EXPECT_TRUE(may_read(good, {})) << good;
  for (const char* bad : {"http://hostile.example", "https://hostile.example",
                          "https://app.foxglove.dev.hostile.example", "http://app.foxglove.dev", "null"})
    EXPECT_FALSE(may_read(bad, {})) << bad;
  EXPECT_TRUE(may_read("http://viewer.lab:8080", {"http://viewer.lab:8080"}));
  EXPECT_FALSE(may_read("http://viewer.lab", {"http://viewer.lab:8080"}));
}

TEST(Foxglove, TheServerOffersNothingButItsTopics) {
  const Json info = Json::parse(server_info("17"));
  EXPECT_EQ(info.at("op"), "serverInfo");
  EXPECT_TRUE(info.at("capabilities").empty());
  const Json channels = Json::parse(advertise()).at("channels");
  ASSERT_EQ(channels.size(), kViewerTopics);
  for (std::size_t i = 0; i < channels.size(); ++i) {
    EXPECT_EQ(channels[i].at("id"), i);
    EXPECT_EQ(channels[i].at("encoding"), "json");
    EXPECT_TRUE(Json::parse(channels[i].at("schema").get<std::string>()).is_object());
  }
}

TEST(Foxglove, SubscriptionsAreRead) {
  const auto wish =
      read_client_message(R"({"op":"subscribe","subscriptions":[{"id":7,"channelId":0},{"id":8,"channelId":4}]})");
  EXPECT_EQ(wish.complaint, "");
  ASSERT_EQ(wish.subscribe.size(), 2U);
  EXPECT_EQ(wish.subscribe[1], (std::pair<std::uint32_t, std::uint32_t>(8, 4)));
  EXPECT_EQ(read_client_message(R"({"op":"unsubscribe","subscriptionIds":[7,8]})").unsubscribe.size(), 2U);
}

TEST(Foxglove, NonsenseIsAnsweredAndChangesNothing) {
  for (const char* text :
       {"", "{", "[]", "7", "null", R"({"op":7})", R"({"op":"advertise","channels":[]})",
        R"({"op":"subscribe","subscriptions":[7]})", R"({"op":"subscribe","subscriptions":[{"id":1,"channelId":5}]})",
        R"({"op":"subscribe","subscriptions":[{"id":-1,"channelId":0}]})",
        R"({"op":"subscribe","subscriptions":[{"id":4294967296,"channelId":0}]})"}) {
    const auto wish = read_client_message(text);
    EXPECT_NE(wish.complaint, "") << text;
    EXPECT_TRUE(wish.subscribe.empty() && wish.unsubscribe.empty()) << text;
  }
}

TEST(Foxglove, MessageDataIsLittleEndian) {
  const std::string wanted("\x01\x04\x03\x02\x01\x08\x07\x06\x05\x04\x03\x02\x01{}", 15);
  EXPECT_EQ(message_data(0x01020304, 0x0102030405060708, "{}"), wanted);
}

}  // namespace
}  // namespace ligature::host::stream
