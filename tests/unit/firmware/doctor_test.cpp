// `ligature-firmware doctor` as an acceptance test: histogram, verdict for a scene (by the delay that its loop can
// bear), report, comparison, load.
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <fstream>
#include <thread>

#include "firmware/app/doctor.hpp"
#include "firmware/app/doctor/can_echo.hpp"
#include "firmware/app/doctor/hwlat.hpp"
#include "firmware/app/doctor/load.hpp"
#include "firmware/app/doctor/report.hpp"
#include "firmware/app/doctor/timerlat.hpp"
#include "tests/support/temp_folder.hpp"

namespace ligature::app {
namespace {

TEST(DoctorHistogram, EachMicrosecondHasABin) {
  LatencyHistogram h;
  for (const std::int64_t ns : {-5, 0, 999, 1000, 1999, 250'000, 9'999'999, 10'000'000, 70'000'000}) h.add(ns);
  EXPECT_EQ(h.count(), 9U);
  EXPECT_EQ(h.bins()[0], 3U);
  EXPECT_EQ(h.bins()[1], 2U);
  EXPECT_EQ(h.bins()[250], 1U);
  EXPECT_EQ(h.bins()[9999], 1U);
  EXPECT_EQ(h.over(), 2U);
  EXPECT_EQ(h.max_us(), 70'000.0);
  EXPECT_EQ(h.from(250.0), 4U);
  EXPECT_EQ(h.from(251.0), 3U);
}

TEST(DoctorHistogram, AQuantileIsAtMostOneBinTooHigh) {
  LatencyHistogram h;
  for (int us = 0; us < 1000; ++us) h.add(us * 1000 + 500);
  for (const double q : {0.001, 0.01, 0.5, 0.99, 0.999, 1.0}) {
    const double truth_us = 1000.0 * q - 0.5;
    EXPECT_GE(h.quantile_us(q), truth_us) << q;
    EXPECT_LE(h.quantile_us(q), truth_us + 1.0) << q;
  }
  EXPECT_EQ(LatencyHistogram().quantile_us(0.5), 0.0);
}

TEST(DoctorVerdict, IsByTheSceneAndNotByFixedBounds) {
  LatencyHistogram h;
  for (int i = 0; i < 100; ++i) h.add(90'000);
  EXPECT_EQ(judge(h, 200.0).grade, platform::Grade::kOk);
  EXPECT_EQ(judge(h, 150.0).grade, platform::Grade::kWarn);
  EXPECT_EQ(judge(h, 80.0).grade, platform::Grade::kFail);
  EXPECT_NE(judge(h, 80.0).found.find("100 of 100 later"), std::string::npos) << judge(h, 80.0).found;
  EXPECT_EQ(judge(h, -5.0).grade, platform::Grade::kFail);  // a scene that leaves nothing
}

DoctorReport some_report() {
  DoctorReport r;
  r.started = "2026-01-02T03:04:05Z";
  r.kernel = "6.1.0-rt";
  r.cpu = "a \"CPU\"";
  r.ligature = "1.2.3";
  r.cores = 4;
  r.core = 3;
  r.seconds = 12.5;
  r.load = {"memory", "cpu"};
  r.scene = "scenes/paper.toml";
  r.slack_us = 210.5;
  r.hardware = "none";
  r.checks = {{platform::Grade::kOk, "kernel", "fine", ""}, {platform::Grade::kFail, "own core", "none", "do it"}};
  for (const int us : {3, 3, 4, 250, 20'000}) r.wakeup.add(us * 1000);
  r.worst = {{1.5, 20'000.0}, {2.5, 250.0}};
  CanEcho echo;
  echo.interface = "can0";
  echo.lost = 2;
  echo.round_trips.add(70'000);
  r.can = {echo};
  r.verdict = "ready";
  return r;
}

TEST(DoctorReports, AreReadBackAsTheyWereWritten) {
  const std::string text = to_json(some_report());
  const auto read = report_of(text);
  ASSERT_TRUE(std::holds_alternative<DoctorReport>(read)) << std::get<std::string>(read);
  EXPECT_EQ(to_json(std::get<DoctorReport>(read)), text);
  EXPECT_EQ(std::get<DoctorReport>(read).wakeup.over(), 1U);
}

TEST(DoctorReports, OtherFilesAreRefusedWithOneLine) {
  for (std::string bad : {std::string("{}"), std::string("no"), std::string(), to_json(some_report()).substr(0, 300),
                          std::string(R"({"format":"ligature doctor 1"})")}) {
    const auto read = report_of(bad);
    ASSERT_TRUE(std::holds_alternative<std::string>(read)) << bad;
    EXPECT_EQ(std::get<std::string>(read).find('\n'), std::string::npos);
  }
}

TEST(DoctorReports, AComparisonMarksWhatDiffers) {
  auto other = some_report();
  other.kernel = "6.1.0";
  other.wakeup.add(400'000);
  const std::string text = compare(some_report(), "a.json", other, "b.json");
  const auto line = [&](const std::string& begin) {
    const auto at = text.find("\n" + begin) + 1;
    return text.substr(at, text.find('\n', at) - at);
  };
  EXPECT_TRUE(line("kernel").ends_with("*")) << text;
  EXPECT_FALSE(line("cpu").ends_with("*")) << text;
  EXPECT_TRUE(line("300 us or later").find("2e+05 a million") != std::string::npos) << text;
  EXPECT_TRUE(line("can0 round trip").find("70 us") != std::string::npos) << text;
}

/// Two rows of one name are two rows, and a row that only one report has is shown.
TEST(DoctorReports, AComparisonHasEveryRowOfBoth) {
  using platform::Grade;
  DoctorReport a = some_report(), b = some_report();
  a.checks = {{Grade::kOk, "CAN", "can0: up", ""}, {Grade::kOk, "CAN", "can1: up", ""}};
  b.checks = {{Grade::kOk, "CAN", "can0: up", ""},
              {Grade::kFail, "CAN", "can1: bus-off", ""},
              {Grade::kFail, "rights", "none", ""}};
  b.scene = "scenes/suture-3-0.toml";
  const std::string text = compare(a, "A", b, "B");
  const auto line_of = [&](const std::string& word) {
    const auto at = text.find(word);
    if (at == std::string::npos) return std::string();
    const auto begin = text.rfind('\n', at) + 1;
    return text.substr(begin, text.find('\n', at) - begin);
  };
  EXPECT_NE(line_of("can1: up").find("FAIL can1: bus-off   *"), std::string::npos) << text;
  EXPECT_NE(line_of("FAIL none").find("not checked"), std::string::npos) << text;
  EXPECT_NE(line_of("suture-3-0").find("*"), std::string::npos) << text;
  EXPECT_EQ(line_of("can0: up").find("*"), std::string::npos) << text;
}

TEST(DoctorHwlat, TheLongestGapIsFoundInTheTrace) {
  const char* trace =
      "# tracer: hwlat\n#\n"
      "           <...>-1729    [001] d...   678.473449: #1     inner/outer(us):   11/12    ts:1581527483.343962693 "
      "count:6\n"
      "           <...>-1729    [004] d...   689.556542: #2     inner/outer(us):   16/9     ts:1581527494.889008092 "
      "count:1\n";
  EXPECT_EQ(longest_gap_us(trace), 16.0);
  EXPECT_FALSE(longest_gap_us("# tracer: hwlat\n").has_value());
  EXPECT_FALSE(longest_gap_us("inner/outer(us): x/y").has_value());
}

TEST(DoctorHwlat, EndsWhenItIsStoppedAndSwitchesTheTracerOff) {
  const std::atomic<bool> stop{true};
  EXPECT_NE(look_for_gaps("/no/such/folder", 3600.0, stop).find("not looked for"), std::string::npos);
  const std::string& folder = test::temp_folder();
  const auto put = [&](const char* name, const char* text) { std::ofstream(folder + name) << text; };
  put("available_tracers", "blk hwlat function nop\n");
  put("current_tracer", "nop\n");
  put("trace", "#1     inner/outer(us):   11/12    ts:1.5 count:6\n");
  EXPECT_EQ(look_for_gaps(folder, 3600.0, stop), "gaps of up to 12 us in 0 s (tracer hwlat)");
  std::string left;
  std::ifstream(folder + "current_tracer") >> left;
  EXPECT_EQ(left, "nop");
  put("current_tracer", "function\n");
  EXPECT_NE(look_for_gaps(folder, 3600.0, stop).find("another tracer"), std::string::npos);
}

/// The trace of Debian's rtla 6.1 in the guest, shortened; in it, a thread and an interrupt were added to one wake-up.
TEST(DoctorTimerlat, TheCulpritIsInTheTraceOfTheLastWakeUp) {
  const std::string trace =
      "# tracer: timerlat\n"
      "          <idle>-0     [000] d..h1..     4.637306: #1136  context    irq timer_latency       601 ns\n"
      "          <idle>-0     [000] dn.h2..     4.637315: irq_noise: old:99 start 4.637305255 duration 9000 ns\n"
      "      timerlat/0-151   [000] .......     4.637318: #1136  context thread timer_latency     12000 ns\n"
      "          <idle>-0     [000] d..h1..     4.638306: #1137  context    irq timer_latency       701 ns\n"
      "          <idle>-0     [000] dn.h2..     4.638315: irq_noise: local_timer:236 start 4.638305255 duration 9569 "
      "ns\n"
      "          <idle>-0     [000] d...3..     4.638317: thread_noise: kworker/0:1:33 start 4.638315676 duration "
      "21842 ns\n"
      "          <idle>-0     [000] d...3..     4.638319: softirq_noise:    TIMER:1 start 4.638316 duration 1500 ns\n"
      "          <idle>-0     [000] d...3..     4.638320: nmi_noise: start 4.638317 duration 600 ns\n"
      "      timerlat/0-151   [000] .......     4.638342: #1137  context thread timer_latency     36975 ns\n"
      "      timerlat/0-151   [000] d..h2..     4.638361: irq_noise: irq_work:246 start 4.638358814 duration 1463 ns\n";
  EXPECT_EQ(delayed_by(trace),
            "37 us late, the timer's interrupt 1 us; thread kworker/0:1:33 took 22 us; interrupt local_timer:236 took "
            "10 us; softirq TIMER:1 took 2 us");
  EXPECT_EQ(delayed_by("# tracer: timerlat\n"), "");
  const std::string stack =
      "      timerlat/0-151   [000] ....1..     4.638362: <stack trace>\n => timerlat_irq\n => __hrtimer_run_queues\n"
      " => hrtimer_interrupt\n => asm_sysvec_apic_timer_interrupt\n => native_safe_halt\n => do_idle\n";
  EXPECT_EQ(delayed_by(trace + stack), delayed_by(trace)) << "the interrupt itself was in time";
  const std::string late_interrupt =
      "          <idle>-0     [000] d..h1..     5.638306: #2137  context    irq timer_latency     90000 ns\n";
  EXPECT_EQ(delayed_by(trace + late_interrupt + stack),
            "90 us late, the timer's interrupt 90 us, the thread not yet awake (it interrupted native_safe_halt)")
      << "newer versions of rtla stop here";
  EXPECT_EQ(delayed_by(""), "");
}

TEST(DoctorLoad, EndsByItselfAndIsNotRealTime) {
  Load load(0.3);
  ASSERT_EQ(load.kinds().size(), 4U);
  const auto limit = std::chrono::steady_clock::now() + std::chrono::seconds(60);  // only ends a hang
  while (load.running() > 0 && std::chrono::steady_clock::now() < limit)
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  EXPECT_EQ(load.running(), 0);
}

TEST(DoctorLoad, EndsWithItsOwner) {
  const auto before = std::chrono::steady_clock::now();
  { const Load load(3600.0); }
  EXPECT_LT(std::chrono::steady_clock::now() - before, std::chrono::seconds(60));
}

TEST(DoctorCan, AnInterfaceThatIsNotThereIsAProblemAndNoMeasurement) {
  const CanEcho echo = measure_echo("nosuchcan0", 0.1);
  EXPECT_NE(echo.problem, "");
  EXPECT_EQ(echo.round_trips.count(), 0U);
}

}  // namespace
}  // namespace ligature::app
