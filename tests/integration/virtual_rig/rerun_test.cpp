// A recorded run is repeated from its records, bit by bit, whatever happened in it; a run that deviates from its record
// is detected.
#include <gtest/gtest.h>

#include <bit>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "host/lab/outcome.hpp"
#include "host/lab/rerun/rerun.hpp"
#include "host/lab/rerun/rerun_files.hpp"
#include "host/log_reader.hpp"
#include "host/log_writer.hpp"
#include "host/messages.hpp"
#include "ligature_source_dir.hpp"
#include "protocol/scene/recorded_scene.hpp"
#include "protocol/scene/text_file.hpp"
#include "tests/integration/virtual_rig/simulated_rig.hpp"
#include "tests/support/random.hpp"
#include "tests/support/temp_folder.hpp"

namespace ligature {
namespace {

using namespace std::chrono_literals;
using lab::Nanoseconds;

constexpr std::int64_t kTicks = 2400, kBit = 690;

struct Case {
  const char* file;
  std::array<std::vector<scene::GripKey>, 2> keys;
  const char* parameter;  // override that is applied while force is on
  const char* other;      // override of the scene that replaces the first one
  // Time that each piece of the physics' work takes, so long that a tick is cut off by its deadline.
  Nanoseconds cut;
};

const Case kPaper{"paper.toml",
                  {{{{0.0, {0.2, 0, 3.0}, false}, {0.5, {0.0, 0, 3.0}, true}, {2.0, {0.6, 0, 3.0}, true}},
                    {{0.0, {0.2, 0, 1.5}, true}, {0.3, {0.2, 0, 1.5}, true}, {1.9, {2.5, 0.5, 1.8}, true}}}},
                  "contact.friction=0.45",
                  "suture.nodes=35",
                  400us};
const Case kSuture{"suture-3-0.toml",
                   {{{{0.0, {0.0, 0.0, 0.20}, false}, {0.3, {0.0, 0.0, 0.20}, true}, {2.0, {0.01, 0.0, 0.19}, true}},
                     {{0.0, {0.0, 0.0, 0.06}, false}, {0.3, {0.0, 0.0, 0.06}, true}, {1.8, {0.06, 0.05, 0.12}, true}}}},
                   "contact.friction=0.4",
                   "suture.initial=" LIGATURE_SOURCE_DIR "/scenes/shapes/overhand-loose.csv",
                   15us};

std::string path_of(const Case& c) { return LIGATURE_SOURCE_DIR "/scenes/" + std::string(c.file); }
std::string text_of(const Case& c) {
  return std::get<std::string>(scene::read_text(path_of(c), scene::kMostScene_bytes));
}
scene::Scene scene_of(const Case& c, const std::vector<std::string>& overrides) {
  return std::get<scene::Scene>(scene::parse_scene(text_of(c), path_of(c), overrides));
}

scene::GripperScript script_of(const Case& c) {
  scene::GripperScript script;
  for (std::size_t h = 0; h < 2; ++h) script.keys[h] = c.keys[h];
  return script;
}

lab::RigSetup setup_of(const Case& c) {
  lab::RigSetup setup{.scene = scene_of(c, {})};
  setup.scene_file = path_of(c);
  setup.scene_toml = scene::recorded_text(text_of(c), {}, setup.scene);
  return setup;
}

/// A rig in which every kind of recorded event occurs.
struct EventfulRig : lab::VirtualRig {
  EventfulRig(const Case& c, std::uint64_t seed) : VirtualRig(setup_of(c), script_of(c)), what(c), random(seed) {
    cycle.listen(plants);
    stall_at = 1300;
    stall_for = Nanoseconds(3ms + std::chrono::microseconds(random() % 3000));
    const auto late = static_cast<std::int64_t>(900 + random() % 50);
    physics.stalls = [late](std::int64_t n) {
      return n == late || n == late + 40 ? Nanoseconds(4300us) : Nanoseconds(0);
    };
    each_tick = [this] { happen(cycle.periods()); };
  }

  void happen(std::int64_t tick) {
    const bool late_ones_too = tick > 890 && tick < 1000;
    physics.per_question = late_ones_too || (tick > 700 && random() % 7 == 0) ? what.cut : Nanoseconds(0);
    if (tick == 800) offer({what.parameter}, true);
    if (tick == 1500) outlets->commands.push({1, rt::CommandKind::kResetThread});
    if (tick == 1700) outlets->commands.push({2, rt::CommandKind::kDisarm});
    if (tick == 1900) offer({what.other}, false);
    if (tick == 1950) outlets->commands.push({3, rt::CommandKind::kArm});
    if (tick == 2200) offer({what.other, what.parameter}, true);
    if (control::Plant* back = plants.collect(); back != nullptr && back->taken)
      scene_changed(next, scene::recorded_text(text_of(what), overrides, next), back->first_tick);
  }

  void offer(std::vector<std::string> with, bool keeps_motion) {
    overrides = std::move(with);
    next = scene_of(what, overrides);
    plant = std::make_unique<control::Plant>(control::Plant{
        std::get<physics::Simulation>(physics::Simulation::make(next)), next.hands, keeps_motion, false});
    plants.offer(plant.get());
  }

  const Case& what;
  test::Random random;
  control::PlantHandover plants;
  std::unique_ptr<control::Plant> plant;
  std::vector<std::string> overrides;
  scene::Scene next;
};

/// Checks that the recording has events of every kind: lost periods, late and cut ticks, grasps, and so on.
void expect_eventful(const EventfulRig& rig) {
  std::int64_t lost = 0, late = 0, cut = 0, held = 0, several = 0, bent = 0;
  for (const auto& r : rig.records) {
    lost += (r.flags & rt::kPeriodLost) != 0;
    late += (r.flags & rt::kThreadLate) != 0;
    cut += r.thread_cut_at >= 0;
    several += r.thread_steps > 1;
    held += r.grasped_node[0] >= 0 && r.grasped_node[1] >= 0;
    bent += r.tool_p_W_m[1] != r.p_WT_m[1];
  }
  EXPECT_GE(lost, 3);
  EXPECT_GE(late, 4);
  EXPECT_GT(cut, 50);
  EXPECT_GT(held, 300);
  EXPECT_GE(several, 1) << "a tick of the thread that no record but the steps tells";
  const auto& last = rig.records.back();
  EXPECT_EQ(last.thread_resets, 1);
  EXPECT_EQ(last.thread_scenes, 1);
  EXPECT_EQ(last.thread_parameters, 2);
  if (rig.setup.scene.hands.device_N_per_m) {
    EXPECT_GT(bent, 100) << "the tool is not where the device is";
  }
}

std::string recorded(const Case& c, const std::string& name) {
  const std::string log = test::temp_folder() + name;
  std::filesystem::remove(log);
  EventfulRig rig(c, 1);
  rig.record(log);
  EXPECT_EQ(rig.run(kTicks), std::nullopt);
  expect_eventful(rig);
  return log;
}

/// Copies a recording and applies `change` to each message; a message is left out if it returns false.
template <class Change>
std::string changed(const std::string& log, const std::string& name, Change change) {
  const std::string to = test::temp_folder() + name;
  host::LogReader reader(log);
  host::LogWriter writer(to, true);
  while (const host::LogEvent* event = reader.next()) {
    std::vector<std::byte> bytes(event->data.begin(), event->data.end());
    const std::string channel(event->channel);
    if (channel == host::kTicksChannel) {
      auto batch = *host::decode<ligature_msg::tick_batch_t>(bytes);
      if (!change(batch)) continue;
      bytes.resize(static_cast<std::size_t>(batch.getEncodedSize()));
      batch.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
    }
    if (channel != host::kStatusChannel || change.keeps_status(bytes))
      writer.write(event->timestamp_us, channel, bytes);
  }
  writer.close();
  return to;
}

struct KeepStatus {
  static bool keeps_status(std::vector<std::byte>&) { return true; }
};

struct OneBit : KeepStatus {
  bool operator()(ligature_msg::tick_batch_t& batch) const {
    for (auto& t : batch.ticks)
      if (t.tick == kBit) {
        auto& x = t.tool_p_W_m[1][0];
        x = std::bit_cast<double>(std::bit_cast<std::uint64_t>(x) ^ 1U);
      }
    return true;
  }
};

struct Without : KeepStatus {
  std::int64_t first, last;
  bool operator()(const ligature_msg::tick_batch_t& batch) const {
    return batch.ticks.back().tick < first || batch.ticks.front().tick > last;
  }
};

struct WithoutScene {
  bool operator()(ligature_msg::tick_batch_t&) const { return true; }
  static bool keeps_status(std::vector<std::byte>& bytes) {
    auto status = *host::decode<ligature_msg::status_t>(bytes);
    status.scene_toml = "";
    bytes.resize(static_cast<std::size_t>(status.getEncodedSize()));
    status.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
    return true;
  }
};

std::string refusal_of(const lab::RerunOptions& options) {
  try {
    (void)lab::rerun(options);
  } catch (const lab::Refusal& refusal) {
    EXPECT_EQ(refusal.code, lab::kBadInput);
    return refusal.what();
  }
  return "nothing";
}

class Rerun : public ::testing::TestWithParam<const Case*> {};

INSTANTIATE_TEST_SUITE_P(Of, Rerun, ::testing::Values(&kPaper, &kSuture),
                         [](const auto& given) { return given.param == &kPaper ? "Paper" : "Suture"; });

TEST_P(Rerun, IsTheSameToTheBitAndOneBitOfAToolShows) {
  const std::string log = recorded(*GetParam(), "eventful.lcmlog");
  const auto same = lab::rerun({.log = log});
  EXPECT_TRUE(same.differences.are_none()) << same.differences.first();
  EXPECT_GE(same.differences.ticks(), kTicks);
  EXPECT_EQ(same.differences.ticks(), same.ticks);
  EXPECT_EQ(same.unknown_ticks, 0) << same.why_unknown;
  EXPECT_GT(same.differences.shapes(), kTicks / 20);
  EXPECT_LE(same.shapes_alone, 1) << "that of a last tick, which no record tells";
  EXPECT_GT(same.differences.recorded().force[1].peak_N, 0.0);
  EXPECT_GT(same.differences.recorded().lost_ticks, 1.0);
  EXPECT_EQ(same.differences.recorded().lost_ticks, same.differences.again().lost_ticks);

  const auto other = lab::rerun({.log = changed(log, "bit.lcmlog", OneBit{})});
  EXPECT_GT(other.differences.different_ticks(), 0);
  EXPECT_EQ(other.differences.first().substr(0, 10), "tick 690: ") << other.differences.first();

  const auto uncut = lab::rerun({.log = log, .cuts = false});
  EXPECT_GT(uncut.differences.different_ticks(), 100) << "the cuts are part of it";
}

TEST_P(Rerun, OtherSettingsDifferAndTheirRecordingIsOne) {
  const std::string log = recorded(*GetParam(), "base.lcmlog"), out = test::temp_folder() + "out";
  const std::vector<std::string> set{"contact.friction=0.05", "hands.coupling_N_s_per_m=0.5"};
  const auto other = lab::rerun({.log = log, .overrides = set, .cuts = false, .output = lab::files_in(out, set)});
  const auto& d = other.differences;
  EXPECT_GT(d.different_ticks(), 100);
  EXPECT_GT(d.different_shapes(), 10);
  EXPECT_GT(d.apart()[1].peak_N, 0.0);
  EXPECT_GT(d.shape_largest_m(), 0.0);
  EXPECT_GE(d.shape_largest_m(), d.shape_rms_m());
  EXPECT_LT(d.again().lost_ticks, d.recorded().lost_ticks) << "nobody cut it";
  const auto summary = nlohmann::json::parse(lab::to_json(other));
  EXPECT_FALSE(summary["equal"]);
  EXPECT_NE(summary["recorded"]["right_rms_N"], summary["rerun"]["right_rms_N"]);
  for (const char* name : {"forces.csv", "shapes.csv", "rerun.lcmlog"})
    EXPECT_GT(std::filesystem::file_size(out + "/" + name), 1000U);

  const auto again = lab::rerun({.log = out + "/rerun.lcmlog"});
  EXPECT_TRUE(again.differences.are_none()) << again.differences.first();
  EXPECT_EQ(again.differences.ticks(), d.ticks());
}

TEST_P(Rerun, AfterAHoleTheThreadIsKnownAgainFromTheNextResetOn) {
  const std::string log = recorded(*GetParam(), "whole.lcmlog");
  for (const auto& [first, last] :
       {std::pair{std::int64_t{0}, std::int64_t{400}}, std::pair{std::int64_t{1000}, std::int64_t{1020}}}) {
    Without hole{{}, first, last};
    const auto part = lab::rerun({.log = changed(log, "part.lcmlog", hole)});
    EXPECT_TRUE(part.differences.are_none()) << part.differences.first();
    EXPECT_GT(part.unknown_ticks, first == 0 ? 1000 : 400);
    EXPECT_GT(part.differences.ticks(), kTicks - 1550) << part.why_unknown;
  }
}

TEST(RerunRefuses, WhatHasNotWhatItNeedsAndWritesNothing) {
  EventfulRig rig(kPaper, 1);
  const std::string log = test::temp_folder() + "short.lcmlog", out = test::temp_folder() + "never";
  rig.record(log);
  ASSERT_EQ(rig.run(300), std::nullopt);
  const auto refused = [&](const std::string& file, std::vector<std::string> set = {}) {
    return refusal_of({.log = file, .overrides = std::move(set), .output = lab::files_in(out, {})});
  };
  EXPECT_NE(refused(changed(log, "no_scene.lcmlog", WithoutScene{})).find("holds no text of its scene"),
            std::string::npos);
  EXPECT_NE(refused(changed(log, "late.lcmlog", Without{{}, 0, 100})).find("no reset and no other scene"),
            std::string::npos);
  EXPECT_NE(refused(changed(log, "none.lcmlog", Without{{}, 0, 100000})).find("protocol_version 2"), std::string::npos);
  EXPECT_NE(refused(log, {"suture.nodes=1"}).find("allowed integer 2 .. 5000"), std::string::npos);
  EXPECT_NE(refused(log, {"time.tick_s=0.002"}).find("allowed the recording's period"), std::string::npos);
  EXPECT_NE(refusal_of({.log = log, .session = 2, .output = lab::files_in(out, {})})
                .find("--session: found 2, allowed 1 .. 1"),
            std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(out));
}

}  // namespace
}  // namespace ligature
