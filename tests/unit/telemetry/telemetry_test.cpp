// The messages that telemetry sends for given tick records, with time as an argument and a sink that stores everything.
#include "firmware/telemetry/telemetry.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "firmware/telemetry/lcm_link.hpp"
#include "firmware/telemetry/messages.hpp"

namespace ligature::telemetry {
namespace {

constexpr Names kNames{[](int s) { return s == 0 ? "OFF" : "ON"; }, [](int) { return "broken"; },
                       [](int fault) { return fault == 13; }};

/// Steady and wall clock both at that time, as if the wall clock is never set.
Moment at(std::int64_t us) { return {us, us}; }

class Memory final : public Sink {
 public:
  void send(const ligature_msg::tick_batch_t& m) override { batches.push_back(m); }
  void send(const ligature_msg::thread_t& m) override { shapes.push_back(m); }
  void send(const ligature_msg::status_t& m) override { statuses.push_back(m); }
  void send(const ligature_msg::event_t& m) override { events.push_back(m); }
  void send(const ligature_msg::offer_t& m) override { offers.push_back(m); }
  std::vector<ligature_msg::tick_batch_t> batches;
  std::vector<ligature_msg::thread_t> shapes;
  std::vector<ligature_msg::status_t> statuses;
  std::vector<ligature_msg::event_t> events;
  std::vector<ligature_msg::offer_t> offers;
};

class TelemetryTest : public ::testing::Test {
 protected:
  void push(std::int64_t tick) {
    record.tick = tick;
    outlets->records.push(record);
  }
  ligature_msg::command_t command(std::int8_t kind) {
    ligature_msg::command_t c{};
    c.id = 7;
    c.kind = kind;
    return c;
  }
  std::unique_ptr<rt::Outlets> outlets = std::make_unique<rt::Outlets>();
  Memory sink;
  Session session{42, "1.2.3", {"a.toml", "text", 3.3, 0.05, false}, 0.001, true, "flight.rec"};
  Telemetry telemetry{session, kNames, *outlets, sink};
  rt::TickRecord record;
};

TEST_F(TelemetryTest, AChangeOfSceneIsToldAtOnceAndInEveryStatusAfterIt) {
  ligature_msg::offer_t offer{};
  offer.scenes = {"a.toml", "b.toml"};
  telemetry.set_offer(offer);
  telemetry.step(at(0));
  ASSERT_EQ(sink.offers.size(), 1U);
  EXPECT_EQ(sink.offers[0].scene_count, 2);
  EXPECT_EQ(sink.offers[0].session, 42);
  telemetry.step(at(999'999));
  EXPECT_EQ(sink.offers.size(), 1U);
  telemetry.step(at(1'000'000));
  EXPECT_EQ(sink.offers.size(), 2U);

  push(5);
  telemetry.step(at(1'000'001));
  EXPECT_EQ(sink.statuses.back().admitted, 0);
  telemetry.scene_changed({"b.toml", "other", 1.5, 0.01, true, 4}, "scene b.toml loaded", at(1'000'002));
  ASSERT_EQ(sink.events.back().kind, ligature_msg::event_t::KIND_CHANGE);
  EXPECT_EQ(sink.events.back().tick, 4) << "since it is in force, not since it is told";
  EXPECT_EQ(sink.statuses.back().admitted, 1);
  EXPECT_EQ(sink.events.back().text, "scene b.toml loaded");
  EXPECT_EQ(sink.statuses.back().scene_file, "b.toml");
  EXPECT_EQ(sink.statuses.back().scene_toml, "other");
  EXPECT_EQ(sink.statuses.back().max_force_N, 1.5);
}

TEST_F(TelemetryTest, EveryRecordGoesIntoExactlyOneBatchInOrder) {
  for (std::int64_t t = 0; t < 45; ++t) push(t);
  telemetry.step(at(0));
  ASSERT_EQ(sink.batches.size(), 2U);
  telemetry.finish(at(1));
  ASSERT_EQ(sink.batches.size(), 3U);
  std::int64_t expected = 0;
  for (const auto& batch : sink.batches) {
    EXPECT_EQ(batch.session, 42);
    EXPECT_EQ(batch.count, static_cast<std::int32_t>(batch.ticks.size()));
    for (const auto& t : batch.ticks) EXPECT_EQ(t.tick, expected++);
  }
  EXPECT_EQ(expected, 45);
}

TEST_F(TelemetryTest, MessagesCarryEveryField) {
  record.p_WT_m[1] = {1, 2, 3};
  record.f_device_N[0] = {0.1, 0.2, 0.3};
  record.torque_permille[1] = {4, 5, 6};
  record.grip[1] = true;
  record.dead_man[0] = true;
  record.tpdo_age_ticks = {8, 9};
  record.contacts = 11;
  record.min_gap_m = 1e9;
  push(0);
  telemetry.finish(at(0));
  const auto& m = sink.batches.at(0).ticks.at(0);
  EXPECT_EQ(m.p_WT_m[1][2], 3.0);
  EXPECT_EQ(m.f_device_N[0][1], 0.2);
  EXPECT_EQ(m.torque_permille[1][2], 6);
  EXPECT_EQ(m.grip[1], 1);
  EXPECT_EQ(m.dead_man[0], 1);
  EXPECT_EQ(m.tpdo_age_ticks[1], 9);
  EXPECT_EQ(m.contacts, 11);
  EXPECT_EQ(m.min_gap_m, 1e9);
  EXPECT_EQ(m.grasped_node[0], -1);
}

TEST_F(TelemetryTest, DroppedRecordsAreTold) {
  const auto room = static_cast<std::int64_t>(outlets->records.capacity());
  for (std::int64_t t = 0; t < room + 5; ++t) push(t);
  telemetry.finish(at(0));
  EXPECT_EQ(sink.batches.back().ring_dropped, 5);
}

TEST_F(TelemetryTest, ShapesComeAtSixtyHertzAndOnlyWhenNew) {
  outlets->shape.back().count = 2;
  outlets->shape.back().p_W_m[1] = {1.0F, 2.0F, 3.0F};
  outlets->shape.publish();
  telemetry.step(at(0));
  telemetry.step(at(20'000));  // no new shape
  ASSERT_EQ(sink.shapes.size(), 1U);
  EXPECT_EQ(sink.shapes[0].count, 2);
  EXPECT_EQ(sink.shapes[0].p_W_m[1][2], 3.0F);
  for (std::int64_t us = 30'000; us < 1'030'000; us += 5'000) {
    outlets->shape.publish();
    telemetry.step(at(us));
  }
  // A shape is sent about every 20 ms: at the first call of step() that is at least 16.7 ms after the previous shape.
  EXPECT_NEAR(static_cast<double>(sink.shapes.size()), 51.0, 10.0);
}

TEST_F(TelemetryTest, StatusCountsMissesAndLostPeriods) {
  record.flags = rt::kDeadlineMissed;
  push(0);
  record.flags = rt::kPeriodLost;
  push(1);
  push(2);
  telemetry.step(at(0));
  telemetry.step(at(50'000));
  telemetry.step(at(100'000));
  ASSERT_EQ(sink.statuses.size(), 2U);
  EXPECT_EQ(sink.statuses[1].deadline_misses, 1);
  EXPECT_EQ(sink.statuses[1].periods_lost, 2);
  EXPECT_EQ(sink.statuses[1].scene_toml, "text");
  EXPECT_EQ(sink.statuses[1].realtime, 1);
  EXPECT_EQ(sink.statuses[1].admitted, 0);
  EXPECT_EQ(sink.statuses[1].recorder_file, "flight.rec");
}

/// The wall clock may be set at any time and may start anywhere (1970 on a board without battery).
TEST_F(TelemetryTest, AWallClockThatIsSetChangesTimeStampsOnly) {
  constexpr std::int64_t kSecond = 1'000'000, kBegin = 5 * kSecond;
  for (const std::int64_t step_s : {-60, 3600, -86'400 * 365 * 50}) {
    Telemetry told(session, kNames, *outlets, sink);
    sink = {};
    std::int64_t wall = 1'800'000'000 * kSecond;
    for (std::int64_t us = 0; us < 4 * kSecond; us += 5'000) {
      if (us == 2 * kSecond) wall += step_s * kSecond;
      outlets->shape.publish();
      push(us / 1'000);
      told.step({kBegin + us, wall + us});
    }
    EXPECT_EQ(sink.statuses.size(), 40U) << step_s;
    EXPECT_EQ(sink.offers.size(), 4U) << step_s;
    EXPECT_EQ(sink.shapes.size(), 200U) << step_s;
    EXPECT_EQ(sink.statuses.back().utime, wall + 3'900'000) << "stamped by the clock on the wall";
    EXPECT_EQ(sink.statuses.back().tick, 3'900);
  }
}

TEST_F(TelemetryTest, EventsAreSentWithTheTimeAtWhichTheyAreFound) {
  push(0);
  record.fault = 11;
  push(1);
  telemetry.step(at(5));
  ASSERT_EQ(sink.events.size(), 1U);
  EXPECT_EQ(sink.events[0].tick, 1);
  EXPECT_EQ(sink.events[0].utime, 5);
}

TEST_F(TelemetryTest, CommandsArePassedOnAndAnswered) {
  const auto ack = telemetry.handle(command(ligature_msg::command_t::KIND_ARM), at(9));
  EXPECT_EQ(ack.accepted, 1);
  EXPECT_EQ(ack.id, 7);
  rt::Command passed;
  ASSERT_TRUE(outlets->commands.pop(passed));
  EXPECT_EQ(passed.kind, rt::CommandKind::kArm);
}

TEST_F(TelemetryTest, ACommandIsGivenAChallengeAndPassesWithIt) {
  auto c = command(ligature_msg::command_t::KIND_ARM);
  const auto first = telemetry.turn_away(c, at(9));
  ASSERT_TRUE(first);
  EXPECT_EQ(first->id, 7);
  EXPECT_EQ(first->session, 42);
  EXPECT_EQ(first->utime, 9);
  EXPECT_EQ(first->accepted, 0);
  EXPECT_NE(first->challenge, 0);
  c.session = 42;
  c.challenge = first->challenge;
  EXPECT_FALSE(telemetry.turn_away(c, at(10)));
  EXPECT_EQ(telemetry.handle(c, at(10)).session, 42);
  EXPECT_TRUE(sink.events.empty());
  EXPECT_FALSE(telemetry.turn_away(command(ligature_msg::command_t::KIND_STOP), at(10)));
}

TEST_F(TelemetryTest, APlayedBackCommandIsToldOnceASecondHoweverManyCome) {
  auto replayed = command(ligature_msg::command_t::KIND_ARM);
  replayed.session = 41;
  replayed.challenge = 5;
  for (std::int64_t ms = 0; ms < 1001; ++ms) {
    const auto ack = telemetry.turn_away(replayed, {ms * 1'000, 0});
    ASSERT_TRUE(ack);
    EXPECT_EQ(ack->accepted + ack->challenge, 0);
    EXPECT_NE(ack->reason.find("command of session 41"), std::string::npos);
  }
  ASSERT_EQ(sink.events.size(), 2U);
  EXPECT_EQ(sink.events[0].kind, ligature_msg::event_t::KIND_REFUSED);
  EXPECT_EQ(sink.events[0].code, ligature_msg::command_t::KIND_ARM);
  EXPECT_TRUE(sink.events[0].text.starts_with("arm refused: command of session 41")) << sink.events[0].text;
  EXPECT_TRUE(sink.events[1].text.ends_with("(999 others before it)")) << sink.events[1].text;
}

TEST_F(TelemetryTest, SenselessCommandsAreRefusedWithAReason) {
  EXPECT_EQ(telemetry.handle(command(99), at(0)).accepted, 0);
  EXPECT_EQ(telemetry.handle(command(ligature_msg::command_t::KIND_RESET_FAULT), at(0)).reason, "there is no fault");
  record.fault = 10;
  push(0);
  telemetry.step(at(0));
  EXPECT_EQ(telemetry.handle(command(ligature_msg::command_t::KIND_ARM), at(0)).accepted, 0);
  EXPECT_EQ(telemetry.handle(command(ligature_msg::command_t::KIND_RESET_FAULT), at(0)).accepted, 1);
  record.fault = 13;
  push(1);
  telemetry.step(at(0));
  EXPECT_EQ(telemetry.handle(command(ligature_msg::command_t::KIND_RESET_FAULT), at(0)).reason,
            "fault 13 stays until ligature-firmware is started again");
  for (int i = 0; i < 100; ++i) (void)telemetry.handle(command(ligature_msg::command_t::KIND_STOP), at(0));
  EXPECT_EQ(telemetry.handle(command(ligature_msg::command_t::KIND_STOP), at(0)).reason, "too many commands at once");
}

TEST_F(TelemetryTest, ClutchAndMovesArePassedOnWhereTheyMakeSense) {
  using ligature_msg::command_t;
  rt::Command passed;
  for (const auto kind : {command_t::KIND_CLUTCH_LEFT, command_t::KIND_UNCLUTCH_LEFT, command_t::KIND_CLUTCH_RIGHT,
                          command_t::KIND_UNCLUTCH_RIGHT}) {
    EXPECT_EQ(telemetry.handle(command(kind), at(0)).accepted, 1);
    ASSERT_TRUE(outlets->commands.pop(passed));
    EXPECT_EQ(static_cast<int>(passed.kind), kind);
  }
  EXPECT_EQ(telemetry.handle(command(8), at(0)).accepted, 0);
  EXPECT_EQ(telemetry.handle(command(command_t::KIND_PARK), at(0)).accepted, 0);  // not armed yet
  record.armed = true;
  push(0);
  telemetry.step(at(0));
  EXPECT_EQ(telemetry.handle(command(command_t::KIND_PARK), at(0)).reason, "no hand holds its dead-man");
  record.dead_man[1] = true;
  push(1);
  telemetry.step(at(0));
  EXPECT_EQ(telemetry.handle(command(command_t::KIND_CALIBRATE), at(0)).accepted, 1);
}

std::vector<std::byte> bytes_of(const ligature_msg::command_t& c) {
  std::vector<std::byte> bytes(static_cast<std::size_t>(c.getEncodedSize()));
  EXPECT_GT(c.encode(bytes.data(), 0, static_cast<int>(bytes.size())), 0);
  return bytes;
}

TEST(CommandOf, TakesWhatWasEncodedAndNothingElse) {
  ligature_msg::command_t c{};
  c.id = 5;
  c.text = "desk.toml";
  const auto good = bytes_of(c);
  ASSERT_TRUE(command_of(good));
  EXPECT_EQ(command_of(good)->text, "desk.toml");
  for (std::size_t n = 0; n < good.size(); ++n) EXPECT_FALSE(command_of(std::span(good).first(n))) << n << " bytes";
  auto longer = good;
  longer.push_back(std::byte{0});
  EXPECT_FALSE(command_of(longer));
  EXPECT_FALSE(command_of(std::vector<std::byte>(100'000)));
}

TEST(CommandOf, SurvivesEveryLengthThatATextCanClaim) {
  // Offset of the text length: hash, utime, id, session, challenge, kind.
  constexpr std::size_t kTextLength = 8 + 8 + 8 + 8 + 8 + 1;
  auto message = bytes_of({});
  for (const unsigned claimed : {0U, 2U, 100U, 0x7FFF'FFFFU, 0x8000'0000U, 0xFFFF'FFFFU}) {
    for (std::size_t i = 0; i < 4; ++i) message[kTextLength + i] = static_cast<std::byte>(claimed >> (24 - 8 * i));
    EXPECT_FALSE(command_of(message)) << claimed;
  }
}

TEST(LcmLink, AUrlThatCannotBeOpenedOnlyCounts) {
  LcmLink link("nosuchprovider://", [](const auto&) {});
  EXPECT_FALSE(link.is_open());
  link.listen([](const auto&) { return ligature_msg::ack_t{}; });
  link.send(ligature_msg::status_t{});
  EXPECT_EQ(link.failures(), 1);
  link.wait(0);
}

}  // namespace
}  // namespace ligature::telemetry
