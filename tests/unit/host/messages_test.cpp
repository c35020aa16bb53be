// Messages may have any bytes: decoding succeeds or is rejected, without other effects.
#include <gtest/gtest.h>

#include "synthetic_log.hpp"
#include "tests/support/random.hpp"

namespace ligature::host {
namespace {

using test::encoded;
using Bytes_ = std::vector<std::byte>;

void put_int32(Bytes_& bytes, std::size_t offset, std::uint32_t value) {
  for (std::size_t i = 0; i < 4; ++i) bytes[offset + i] = static_cast<std::byte>(value >> (24 - 8 * i));
}

ligature_msg::status_t some_status() {
  ligature_msg::status_t status{};
  status.scene_file = "paper.toml";
  status.scene_toml = "[suture]\n";
  status.period_s = 1e-3;
  return status;
}

ligature_msg::offer_t some_offer() {
  ligature_msg::offer_t offer{};
  offer.scenes = {"paper.toml", "desk.toml"};
  offer.scene_count = 2;
  offer.previews.resize(2);
  offer.previews[1].about = "on a desk", offer.previews[1].facts = "paper-4";
  offer.previews[1].p_W_m = {{0.0F, 0.0F, 1.0F}, {0.0F, 0.5F, 1.0F}};
  offer.previews[1].point_count = 2;
  offer.parameters.resize(2);
  offer.parameter_count = 2;
  for (auto& p : offer.parameters) p.key = "contact.friction", p.name = "friction", p.value = 0.3, p.highest = 2.0;
  return offer;
}

TEST(Messages, DecodesWhatWasEncoded) {
  const auto batch = decode<ligature_msg::tick_batch_t>(encoded(test::batch_of(7, 100, 20)));
  ASSERT_TRUE(batch);
  EXPECT_EQ(batch->session, 7);
  EXPECT_EQ(batch->ticks[19].tick, 119);
  EXPECT_TRUE(decode<ligature_msg::tick_batch_t>(encoded(test::batch_of(7, 0, 0))));
  EXPECT_TRUE(decode<ligature_msg::thread_t>(encoded(test::thread_of(0, test::straight_points(50)))));
  EXPECT_TRUE(decode<ligature_msg::status_t>(encoded(some_status())));
  ligature_msg::ack_t ack{};
  ack.reason = "not armed";
  EXPECT_EQ(decode<ligature_msg::ack_t>(encoded(ack))->reason, "not armed");
  EXPECT_TRUE(decode<ligature_msg::event_t>(encoded(ligature_msg::event_t{})));
  EXPECT_TRUE(decode<ligature_msg::command_t>(encoded(ligature_msg::command_t{})));
  EXPECT_EQ(decode<ligature_msg::offer_t>(encoded(some_offer()))->parameters[1].highest, 2.0);
  EXPECT_TRUE(decode<ligature_msg::offer_t>(encoded(ligature_msg::offer_t{}))) << "nothing to offer";
}

TEST(Messages, RefusesEveryCutAndForgedCountOfAnOffer) {
  const auto whole = encoded(some_offer());
  for (std::size_t size = 0; size < whole.size(); ++size)
    EXPECT_FALSE(decode<ligature_msg::offer_t>(Bytes(whole).first(size)));
  for (const std::uint32_t count : {0U, 1U, 3U, 0x7FFFFFFFU, 0x80000000U, 0xFFFFFFFFU}) {
    auto forged = whole;
    put_int32(forged, 24, count);
    EXPECT_FALSE(decode<ligature_msg::offer_t>(forged)) << count;
  }
  auto many = some_offer();  // only the count of the points is wrong
  many.previews[1].about.clear(), many.previews[1].facts.clear();
  const auto points = encoded(many);
  const std::size_t at = 24 + 4 + (4 + 11) + (4 + 10) + (5 + 5 + 4 + 4) + (5 + 5 + 4);
  for (const std::uint32_t count : {0U, 1U, 3U, 0x7FFFFFFFU, 0x80000000U, 0xFFFFFFFFU}) {
    auto forged = points;
    put_int32(forged, at, count);
    EXPECT_FALSE(decode<ligature_msg::offer_t>(forged)) << count;
  }
  auto upside_down = some_offer();
  upside_down.parameters[0].lowest = 3.0;
  EXPECT_FALSE(decode<ligature_msg::offer_t>(encoded(upside_down)));
}

TEST(Messages, RefusesForgedArrayLengths) {
  for (const std::uint32_t count : {0U, 19U, 21U, 0x7FFFFFFFU, 0x80000000U, 0xFFFFFFFFU}) {
    auto ticks = encoded(test::batch_of(7, 0, 20));
    put_int32(ticks, 32, count);
    EXPECT_FALSE(decode<ligature_msg::tick_batch_t>(ticks)) << count;
    auto thread = encoded(test::thread_of(0, test::straight_points(20)));
    put_int32(thread, 28, count);
    EXPECT_FALSE(decode<ligature_msg::thread_t>(thread)) << count;
  }
}

TEST(Messages, RefusesForgedStringLengths) {
  for (const std::uint32_t length : {0U, 1000U, 0x7FFFFFFFU, 0x80000000U, 0xFFFFFFFFU}) {
    auto status = encoded(some_status());
    put_int32(status, 28, length);
    EXPECT_FALSE(decode<ligature_msg::status_t>(status)) << length;
    auto ack = encoded(ligature_msg::ack_t{});
    put_int32(ack, 41, length);
    EXPECT_FALSE(decode<ligature_msg::ack_t>(ack)) << length;
    auto event = encoded(ligature_msg::event_t{});
    put_int32(event, 30, length);
    EXPECT_FALSE(decode<ligature_msg::event_t>(event)) << length;
  }
}

TEST(Messages, RefusesEveryCutAndEveryTail) {
  auto bytes = encoded(test::batch_of(7, 0, 2));
  for (std::size_t size = 0; size < bytes.size(); ++size)
    EXPECT_FALSE(decode<ligature_msg::tick_batch_t>(Bytes(bytes).first(size)));
  bytes.push_back(std::byte{0});
  EXPECT_FALSE(decode<ligature_msg::tick_batch_t>(bytes));
}

TEST(Messages, RefusesImplausibleValues) {
  auto batch = test::batch_of(7, 0, 2);
  batch.ticks[1].tick = -1;
  EXPECT_FALSE(decode<ligature_msg::tick_batch_t>(encoded(batch)));
  auto status = some_status();
  status.period_s = 0.0;
  EXPECT_FALSE(decode<ligature_msg::status_t>(encoded(status)));
}

TEST(Messages, SurvivesRandomAndMutatedBytesOnEveryChannel) {
  ligature::test::Random random(3);
  const std::vector<Bytes_> seeds{encoded(test::batch_of(7, 0, 3)),
                                  encoded(test::thread_of(0, test::straight_points(5))),
                                  encoded(some_status()),
                                  encoded(ligature_msg::event_t{}),
                                  encoded(ligature_msg::ack_t{}),
                                  encoded(ligature_msg::command_t{}),
                                  encoded(some_offer())};
  for (int round = 0; round < 3000; ++round) {
    Bytes_ bytes = seeds[random() % seeds.size()];
    for (auto changes = random() % 8; changes > 0; --changes)
      // Leaves the 8 bytes of the type's hash.
      bytes[8 + random() % (bytes.size() - 8)] = static_cast<std::byte>(random());
    if (random() % 4 == 0) bytes.resize(random() % (2 * bytes.size()));
    for (const auto channel :
         {kTicksChannel, kThreadChannel, kStatusChannel, kEventChannel, kAckChannel, kCommandChannel, kOfferChannel})
      static_cast<void>(is_readable(channel, bytes));
  }
}

TEST(Messages, AMessageOfAnotherTypeIsUnreadable) {
  EXPECT_FALSE(is_readable(kStatusChannel, encoded(test::batch_of(7, 0, 3))));
  EXPECT_TRUE(is_readable("LIGATURE_OF_SOMEBODY_ELSE", {}));
}

}  // namespace
}  // namespace ligature::host
