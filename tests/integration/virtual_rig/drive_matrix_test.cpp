// For the drives of every shipped record: how soon their torque ends when the firmware falls silent, when the dead-man
// is released, and when a drive fails; and what remains. The whole rig in virtual time, each trial at another moment.
// docs/drives.md has the rows that the test prints.
#include "tests/integration/virtual_rig/drive_matrix.hpp"

#include <gtest/gtest.h>

#include <cstdio>
#include <fstream>
#include <regex>
#include <sstream>

#include "firmware/control/engagement.hpp"
#include "firmware/platform/cia402_facts.hpp"
#include "ligature_source_dir.hpp"
#include "sim_device/moteus_node.hpp"
#include "tests/support/random.hpp"

namespace ligature {
namespace {

using device::DriveWatchdog;

/// Bounds in ticks, as they follow from a record.
struct Row {
  const char *record, *name, *drives;
  bool has_watchdog = true;  ///< false: the record is told to have none
  const char* remains = "-";

  [[nodiscard]] device::Device device() const {
    device::Device d = ShelfRig::device_of(record);
    if (!has_watchdog) d.cia402.watchdog = DriveWatchdog::kNone;
    return d;
  }
  /// Time after which a drive acts that hears nothing any more: the one that the firmware sets, or that is set in it.
  [[nodiscard]] int watchdog_ms() const {
    const device::Device d = device();
    if (d.odrive) return d.odrive->watchdog_ms;
    if (d.moteus) return lab::VirtualRig::kWatchdog_ms;
    return std::max(lab::VirtualRig::kWatchdog_ms, d.cia402.watchdog_ms);
  }
  /// Periods between two frames that feed the watchdog: torques in every period, or heartbeats.
  [[nodiscard]] int fed_every() const {
    const device::Device d = device();
    const bool by_beats = !d.odrive && !d.moteus && d.cia402.watchdog == DriveWatchdog::kHeartbeat;
    return by_beats ? platform::heartbeat_periods(d, lab::VirtualRig::kWatchdog_ms) : 1;
  }
  /// The watchdog runs from the last frame that feeds it. That is in the last period before the silence. Heartbeats
  /// come at the two hands in turn, half of `fed_every` apart, and the later one counts. Torques of ODrives and moteus
  /// may still be in the interface at the silence, and come up to 0.3 ms after it. So torque acts at the end of tick
  /// `watchdog_ms` at most.
  [[nodiscard]] int silence_at_least() const { return watchdog_ms() - fed_every() / 2 - 1; }
  [[nodiscard]] int silence_at_most() const { return watchdog_ms(); }
  /// The next request samples the button, at once here. The gain takes 50 ticks to fall, and a force of 3.3 N that is
  /// left then at most 14 more (see Controller::kMostOvertimeTicks). The last torque acts until the next SYNC (1).
  static constexpr int kRelease = control::Engagement::kFallTicks + 14 + 1;
  /// The fault comes with the next samples, or, if those have all come before it, a period later; ODrives tell it by
  /// their next heartbeat. The stop acts in the next period.
  [[nodiscard]] int fault_at_most() const {
    const device::Device d = device();
    return 2 + (d.odrive ? d.odrive->heartbeat_ms : 0);
  }
};

const Row kRows[] = {
    {"omni.toml", "omni", "`omni.toml`"},
    {"cartesian.toml", "cartesian", "`cartesian.toml`"},
    {"inverse3.toml", "inverse3", "`inverse3.toml`, the bridge's"},
    {"epos4.toml", "epos4", "`epos4.toml`"},
    {"generic-cia402.toml", "generic", "`generic-cia402.toml`"},
    {"generic-cia402.toml", "without", "the same with `watchdog = \"none\"`", false, "**the last torque**, unchanged"},
    {"odrive.toml", "odrive", "`odrive.toml`"},
    {"moteus.toml", "moteus", "`moteus.toml`", true, "**damping**: torque against the motion; here at most 0.1 N m"},
};

/// Smallest and largest number of ticks that were seen.
struct Seen {
  int least = 1'000'000, most = 0, trials = 0;
  void add(int ticks) {
    least = std::min(least, ticks);
    most = std::max(most, ticks);
    ++trials;
  }
  [[nodiscard]] std::string text() const {
    return least == most ? std::to_string(most) : std::to_string(least) + " to " + std::to_string(most);
  }
};

constexpr std::int64_t kFrom = 2000, kUntil = 4000, kEnd = 4500;
constexpr int kSilences = 40, kReleases = 20, kFaults = 30;

std::vector<Trial> drawn(std::size_t row) {
  test::Random random(2311 + row);
  std::vector<Trial> trials;
  for (int i = 0; i < kSilences + kReleases + kFaults; ++i) {
    const Ends ends = i < kSilences ? Ends::kSilence : i < kSilences + kReleases ? Ends::kRelease : Ends::kFault;
    const std::int64_t from = random.any(kFrom, kUntil);
    const std::size_t hand = random.below(2), drive = random.below(3);
    trials.push_back({ends, from, hand, drive});
  }
  return trials;
}

class DriveMatrix : public testing::TestWithParam<std::size_t> {
 protected:
  void expect_silence(const Outcome& o) {
    if (!row.has_watchdog) {
      EXPECT_TRUE(o.stays) << "the last torque acts until the power is cut";
      EXPECT_EQ(o.trips, 0);
      return;
    }
    EXPECT_EQ(o.trips, 6) << "of each drive";
    const bool damps = row.device().moteus;
    const int last = damps ? o.last_commanded : o.last;
    silence.add(last);
    EXPECT_GE(last, row.silence_at_least());
    EXPECT_LE(last, row.silence_at_most());
    if (!damps) return;
    EXPECT_EQ(o.pushed, 0) << "what remains opposes the motion";
    damping_Nm = std::max(damping_Nm, o.most_left_Nm);
    EXPECT_LE(o.most_left_Nm, static_cast<double>(sim::MoteusSettings{}.damping_most_Nm) + 1e-6);
  }
  void expect(const Trial& trial, const Outcome& o) {
    EXPECT_TRUE(o.was_in_force);
    if (trial.ends == Ends::kSilence) return expect_silence(o);
    if (trial.ends == Ends::kRelease) {
      release.add(o.last);
      EXPECT_LE(o.last, Row::kRelease);
      EXPECT_EQ(o.fault, 0);
      return;
    }
    fault.add(o.last);
    EXPECT_LE(o.last, row.fault_at_most());
    EXPECT_EQ(o.fault, static_cast<int>(control::Fault::kDriveFault));
  }
  [[nodiscard]] std::string text() const {
    std::ostringstream s;
    const auto cell = [&s](int most, const Seen& seen) { s << most << "; seen " << seen.text() << " | "; };
    s << "| " << row.drives << " | yes | ";
    cell(Row::kRelease, release);
    cell(row.fault_at_most(), fault);
    if (!row.has_watchdog)
      s << "never | ";
    else
      cell(row.silence_at_most(), silence);
    s << row.remains << " |";
    return s.str();
  }

  const Row& row = kRows[GetParam()];
  Seen silence, release, fault;
  double damping_Nm = 0.0;
};

TEST_P(DriveMatrix, TorqueEndsAsTheRecordSays) {
  const auto trials = drawn(GetParam());
  MatrixRig rig(row.record, row.device(), row.watchdog_ms());
  const auto outcomes = rig.run(trials, kEnd, row.has_watchdog ? 120 : 350);
  for (std::size_t i = 0; i < trials.size(); ++i) {
    const Trial& t = trials[i];
    SCOPED_TRACE(testing::Message() << "trial " << i << ": " << static_cast<int>(t.ends) << " from period " << t.from
                                    << ", hand " << t.hand << ", drive " << t.drive);
    ASSERT_TRUE(outcomes[i]) << "no torque acted";
    expect(t, *outcomes[i]);
  }
  EXPECT_EQ(damping_Nm > 0.0, row.device().moteus) << "a drive that damps does so while the hands move";
  std::puts(text().c_str());
  std::ostringstream page;
  page << std::ifstream(std::string(LIGATURE_SOURCE_DIR) + "/docs/drives.md").rdbuf();
  // What was seen depends on the draw, and a little on the compiler; the rest of the row does not
  const std::regex seen("; seen [0-9]+( to [0-9]+)?");
  const auto without = [&](const std::string& t) { return std::regex_replace(t, seen, ""); };
  EXPECT_NE(without(page.str()).find(without(text()) + "\n"), std::string::npos)
      << "docs/drives.md is old; its row is\n"
      << text();
}

INSTANTIATE_TEST_SUITE_P(Records, DriveMatrix, testing::Range(std::size_t{0}, std::size(kRows)),
                         [](const auto& row) { return std::string(kRows[row.param].name); });

}  // namespace
}  // namespace ligature
