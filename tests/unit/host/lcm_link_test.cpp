// LcmLink, the host's connection to LCM, within one process and without network.
#include "host/lcm_link.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

namespace ligature::host {
namespace {

ligature_msg::ack_t ack_of(std::int64_t id) {
  ligature_msg::ack_t ack{};
  ack.id = id;
  return ack;
}

TEST(LcmLink, HearsWhatComesOnItsChannels) {
  std::vector<std::int64_t> heard;
  LcmLink link("memq://", "LIGATURE_.*", [&](const Message& message) {
    EXPECT_EQ(message.channel, kAckChannel);
    EXPECT_GT(message.received_us, 0);
    const auto ack = decode<ligature_msg::ack_t>(message.data);
    ASSERT_TRUE(ack);
    heard.push_back(ack->id);
  });
  link.publish("SOMEBODY_ELSE", ack_of(1));
  link.publish(kAckChannel, ack_of(2));
  link.publish(kAckChannel, ack_of(3));
  while (link.receive(0) > 0) {
  }
  EXPECT_EQ(heard, (std::vector<std::int64_t>{2, 3}));
}

TEST(LcmLink, WhatItsHandlerThrowsComesOutOfReceive) {
  LcmLink link("memq://", "LIGATURE_.*", [](const Message&) { throw std::runtime_error("not this one"); });
  link.publish(kAckChannel, ack_of(1));
  EXPECT_THROW(link.receive(0), std::runtime_error);
}

}  // namespace
}  // namespace ligature::host
