// The flight recorder with a disk that blocks, fails or works: every tick from the loop is in the file or counted as
// missing. The test decides when the blocked disk continues, so nothing depends on timing.
#include "firmware/telemetry/flight_recorder.hpp"

#include <gtest/gtest.h>

#include <numeric>

#include "firmware/rt/outlets.hpp"
#include "firmware/telemetry/telemetry.hpp"
#include "tests/unit/telemetry/flight_files.hpp"

namespace ligature::telemetry {
namespace {

using host::FlightReader;
using test::record_of;
using test::ticks_in;

/// A gate that every disk call passes; while it is closed, calls wait at it.
class Door {
 public:
  void pass() noexcept {
    ++waiting_;
    waiting_.notify_all();
    closed_.wait(true);
    --waiting_;
  }
  void close() { closed_ = true; }
  void open() {
    closed_ = false;
    closed_.notify_all();
  }
  /// Returns when a call waits at the gate.
  void wait_for_somebody() const { waiting_.wait(0); }

 private:
  std::atomic<bool> closed_{false};
  std::atomic<int> waiting_{0};
};

struct Doors {
  Door write, sync;
  std::atomic<bool> refuses{false};
};

class SlowDisk final : public Disk {
 public:
  SlowDisk(std::unique_ptr<FileDisk> disk, Doors& doors) : disk_(std::move(disk)), doors_(doors) {}
  bool write(std::span<const std::byte> bytes, std::size_t at) noexcept override {
    doors_.write.pass();
    return !doors_.refuses && disk_->write(bytes, at);
  }
  bool read(std::span<std::byte> bytes, std::size_t at) noexcept override { return disk_->read(bytes, at); }
  void sync() noexcept override {
    doors_.sync.pass();
    disk_->sync();
  }

 private:
  std::unique_ptr<FileDisk> disk_;
  Doors& doors_;
};

class Network final : public Sink {
 public:
  void send(const ligature_msg::tick_batch_t& m) override { ticks += m.count; }
  void send(const ligature_msg::thread_t&) override {}
  void send(const ligature_msg::status_t&) override {}
  void send(const ligature_msg::offer_t&) override {}
  void send(const ligature_msg::event_t& m) override { events.push_back(m); }
  std::int64_t ticks = 0;
  std::vector<ligature_msg::event_t> events;
};

class FlightRecorderTest : public ::testing::Test {
 protected:
  static constexpr std::int64_t kSlots = 5000;
  static constexpr Names kNames{[](int) { return "state"; }, [](int) { return "broken"; }};

  /// @param room number of ticks that memory can hold.
  void start(std::size_t room = FlightRecorder::kRoom) {
    auto disk = std::make_unique<SlowDisk>(test::disk_or_die(path, kSlots), doors);
    recorder = std::make_unique<FlightRecorder>(std::move(disk), path, header_of(test::kFacts, kSlots), room);
    outlets->flight = &recorder->inlet();
  }
  /// Records ticks as the loop does.
  void tick(std::int64_t count, std::int16_t fault = 0) {
    for (std::int64_t i = 0; i < count; ++i) {
      auto record = record_of(next++);
      record.fault = fault;
      outlets->tell(record);
    }
  }
  /// Blocks the disk while it writes one more tick.
  void stand_still() {
    doors.write.close();
    tick(1);
    doors.write.wait_for_somebody();
  }
  std::vector<std::int64_t> all_but(std::int64_t first, std::int64_t last) const {
    std::vector<std::int64_t> ticks(static_cast<std::size_t>(next));
    std::iota(ticks.begin(), ticks.end(), 0);
    std::erase_if(ticks, [&](auto t) { return t >= first && t <= last; });
    return ticks;
  }

  host::test::TestFolder folder;
  std::string path = folder.file("flight.rec");
  Doors doors;
  std::unique_ptr<rt::Outlets> outlets = std::make_unique<rt::Outlets>();
  std::unique_ptr<FlightRecorder> recorder;
  std::int64_t next = 0;
};

TEST_F(FlightRecorderTest, ADiskThatStandsStillForThreeSecondsCostsNoTickAndHoldsNobodyUp) {
  start();
  Network network;
  Telemetry telemetry({}, kNames, *outlets, network, recorder.get());
  stand_still();
  for (int step = 0; step < 600; ++step) {
    tick(5);
    telemetry.step({step * 5'000, step * 5'000});
  }
  EXPECT_EQ(network.ticks, 3000) << "LCM goes on";
  EXPECT_EQ(outlets->records.dropped() + recorder->inlet().dropped(), 0U);
  EXPECT_TRUE(ticks_in(FlightReader(path)).empty()) << "the disk must have stood still";
  doors.write.open();
  recorder->finish();
  EXPECT_EQ(ticks_in(FlightReader(path)), all_but(-1, -1));
  EXPECT_EQ(recorder->missing(), 0);
  EXPECT_TRUE(recorder->take_notes().empty());
}

TEST_F(FlightRecorderTest, ANetworkThatStandsStillCostsTheRecorderNothing) {
  start();
  // Telemetry's ring buffer overflows, because nothing reads from it.
  tick(static_cast<std::int64_t>(rt::Outlets::kRecords) + 500);
  EXPECT_EQ(outlets->records.dropped(), 500U);
  recorder->finish();
  EXPECT_EQ(recorder->missing(), 0);
  EXPECT_EQ(ticks_in(FlightReader(path)).back(), next - 1);
}

TEST_F(FlightRecorderTest, WhatTheMemoryCannotHoldIsCountedAndNamed) {
  start(1000);
  stand_still();
  tick(1500);
  doors.write.open();
  while (ticks_in(FlightReader(path)).size() < 1001) std::this_thread::yield();
  tick(10);
  recorder->finish();
  EXPECT_EQ(ticks_in(FlightReader(path)), all_but(1001, 1500));
  EXPECT_EQ(recorder->missing(), 500);
  const auto notes = recorder->take_notes();
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_EQ(notes[0].fault, 0);
  EXPECT_NE(notes[0].text.find("500 of the ticks 1001..1500 are missing"), std::string::npos) << notes[0].text;
}

TEST_F(FlightRecorderTest, AHoleAtTheVeryEndIsNamedToo) {
  start(1000);
  stand_still();
  tick(1500);
  doors.write.open();
  recorder->finish();
  EXPECT_EQ(ticks_in(FlightReader(path)), all_but(1001, 1500));
  EXPECT_EQ(recorder->missing(), 500);
  ASSERT_EQ(recorder->take_notes().size(), 1U);
}

TEST_F(FlightRecorderTest, ADiskThatIsSlowToSyncDelaysNoWriting) {
  start();
  doors.sync.close();
  tick(1);
  doors.sync.wait_for_somebody();
  tick(3000);
  while (ticks_in(FlightReader(path)).size() < 3001) std::this_thread::yield();
  doors.sync.open();
  recorder->finish();
  EXPECT_EQ(recorder->missing(), 0);
}

TEST_F(FlightRecorderTest, ADiskThatRefusesIsCountedAndDoesNotEndTheProcess) {
  start();
  doors.refuses = true;
  stand_still();
  tick(99);
  doors.write.open();
  while (recorder->missing() < 100) std::this_thread::yield();
  doors.refuses = false;
  tick(10);
  recorder->finish();
  EXPECT_EQ(ticks_in(FlightReader(path)), all_but(0, 99));
  EXPECT_EQ(recorder->missing(), 100);
  EXPECT_NE(recorder->take_notes().at(0).text.find("the disk does not take them"), std::string::npos);
}

TEST_F(FlightRecorderTest, AFaultSavesTheTicksBeforeItAndIsNoted) {
  start();
  tick(2500);
  tick(100, 11);
  tick(1);
  tick(1, 12);
  recorder->finish();
  Network network;
  Telemetry telemetry({}, kNames, *outlets, network, recorder.get());
  telemetry.finish({0, 7});
  std::erase_if(network.events, [](const auto& e) { return e.kind != ligature_msg::event_t::KIND_RECORDER; });
  ASSERT_EQ(network.events.size(), 2U);
  const auto& event = network.events[0];
  EXPECT_EQ(event.tick, 2500);
  EXPECT_EQ(event.code, 11);
  EXPECT_EQ(event.utime, 7);
  const FlightReader saved(event.text.substr(event.text.find(path)));
  EXPECT_EQ(saved.fault(), 11);
  const auto ticks = ticks_in(saved);
  ASSERT_EQ(ticks.size(), static_cast<std::size_t>(FlightRecorder::kTicksPerFault));
  EXPECT_EQ(ticks.back(), 2500) << "the tick that sees the fault is the last one";
  EXPECT_EQ(network.events[1].code, 12);
}

TEST_F(FlightRecorderTest, OpensAFileOfItsOwnOrSaysWhyNot) {
  auto opened = FlightRecorder::open(path, test::kFacts, 10);
  ASSERT_TRUE(std::holds_alternative<std::unique_ptr<FlightRecorder>>(opened));
  EXPECT_EQ(std::get<0>(opened)->path(), path);
  const auto again = FlightRecorder::open(path, test::kFacts, 10);
  ASSERT_TRUE(std::holds_alternative<std::string>(again));
  EXPECT_NE(std::get<std::string>(again).find("another process records into it"), std::string::npos);
}

FlightScene scene_of(std::int64_t first_tick, const std::string& name, bool admitted = true) {
  return {first_tick, 1.5, admitted, name, "[suture]\n# of " + name};
}

std::string file_at(const FlightReader& reader, std::int64_t tick) { return reader.scene_at(tick).facts.scene_file; }

TEST_F(FlightRecorderTest, NamesTheSceneInForceAtEachTick) {
  start();
  tick(100);
  recorder->scene_changed(scene_of(40, "b.toml"));
  recorder->scene_changed(scene_of(90, "c.toml", false));
  recorder->finish();
  const FlightReader reader(path);
  EXPECT_EQ(reader.ticks(), 100U);
  for (const auto& [at, name] :
       {std::pair{0, "a.toml"}, {39, "a.toml"}, {40, "b.toml"}, {89, "b.toml"}, {90, "c.toml"}})
    EXPECT_EQ(file_at(reader, at), name) << at;
  EXPECT_EQ(reader.scene_at(50).facts.scene_toml, "[suture]\n# of b.toml");
  EXPECT_EQ(reader.scene_at(50).facts.max_force_N, 1.5);
  EXPECT_TRUE(reader.scene_at(50).admitted);
  EXPECT_FALSE(reader.scene_at(90).admitted);
  EXPECT_EQ(reader.facts().scene_file, "a.toml") << "at the oldest tick";
}

TEST_F(FlightRecorderTest, ARingThatHasForgottenTheFirstSceneSaysWhichItHolds) {
  start();
  recorder->scene_changed(scene_of(1000, "b.toml"));
  tick(kSlots + 2000);
  recorder->finish();
  EXPECT_EQ(FlightReader(path).facts().scene_file, "b.toml");
}

TEST_F(FlightRecorderTest, KeepsTheNewestScenesOfMany) {
  start();
  constexpr std::int64_t kMany = 3 * recorder::kMostScenes / 2;
  for (std::int64_t i = 1; i <= kMany; ++i) recorder->scene_changed(scene_of(i, std::to_string(i)));
  tick(kMany + 1);
  recorder->finish();
  const FlightReader reader(path);
  EXPECT_EQ(reader.scenes().size(), 1 + recorder::kMostScenes);
  for (std::int64_t i = kMany - static_cast<std::int64_t>(recorder::kMostScenes) + 1; i <= kMany; ++i)
    EXPECT_EQ(file_at(reader, i), std::to_string(i));
}

TEST_F(FlightRecorderTest, WhatAFaultSavesNamesTheScenesOfItsTicks) {
  start();
  tick(3000);
  recorder->scene_changed(scene_of(100, "b.toml"));
  recorder->scene_changed(scene_of(500, "c.toml"));
  recorder->scene_changed(scene_of(2900, "d.toml", false));
  tick(1, 21);
  recorder->finish();
  const auto notes = recorder->take_notes();
  ASSERT_EQ(notes.size(), 1U);
  const FlightReader saved(notes[0].text.substr(notes[0].text.find('/')));
  EXPECT_EQ(saved.fault(), 21);
  EXPECT_EQ(saved.ticks(), 2000U);
  EXPECT_EQ(file_at(saved, 1001), "c.toml");
  EXPECT_EQ(file_at(saved, 3000), "d.toml");
  EXPECT_FALSE(saved.scene_at(3000).admitted);
  EXPECT_EQ(saved.facts().scene_file, "c.toml");
  EXPECT_EQ(saved.scenes().size(), 3U) << "the launch's, and the two of its ticks";
}

// The loop switches to a scene, a fault follows in the next tick, and telemetry learns of the scene only afterwards.
TEST_F(FlightRecorderTest, WhatAFaultSavesWaitsForASceneThatIsOnItsWay) {
  start();
  recorder->expect_scene(true);
  tick(100);
  tick(1, 21);
  // Usually enough time for the writer to reach the fault; if not, this test checks less.
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  EXPECT_TRUE(recorder->take_notes().empty());
  recorder->scene_changed(scene_of(100, "b.toml"));
  recorder->expect_scene(false);
  recorder->finish();
  const auto notes = recorder->take_notes();
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_EQ(file_at(FlightReader(notes[0].text.substr(notes[0].text.find('/'))), 100), "b.toml");
}

}  // namespace
}  // namespace ligature::telemetry
