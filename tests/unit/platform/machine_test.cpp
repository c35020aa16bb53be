// Machine checks of `ligature-firmware doctor`, on machines simulated by files of /proc and /sys.
#include "firmware/platform/machine.hpp"

#include "firmware/platform/core_checks.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

namespace ligature::platform {
namespace {

namespace fs = std::filesystem;

class MachineTest : public ::testing::Test {
 protected:
  MachineTest() {
    std::string name = (fs::temp_directory_path() / "ligature-machine-XXXXXX").string();
    folder = ::mkdtemp(name.data());
    machine.root = folder + "/";
    machine.ip_details = [this](const std::string&) { return details; };
  }
  ~MachineTest() override { fs::remove_all(folder); }

  void put(const std::string& file, const std::string& text) {
    fs::create_directories(fs::path(folder + "/" + file).parent_path());
    std::ofstream(folder + "/" + file) << text << "\n";
  }
  static Grade grade(const std::vector<Check>& checks, const std::string& what) {
    const auto at = std::ranges::find(checks, what, &Check::what);
    EXPECT_NE(at, checks.end()) << what;
    EXPECT_EQ(at->grade == Grade::kOk, at->remedy.empty()) << what;
    return at->grade;
  }
  void put_good_machine() {
    put("proc/sys/kernel/osrelease", "6.1.0-rt");
    put("sys/kernel/realtime", "1");
    put("proc/self/limits",
        "Limit                     Soft Limit           Hard Limit           Units\n"
        "Max locked memory         unlimited            unlimited            bytes\n"
        "Max realtime priority     90                   90");
    put("sys/devices/system/cpu/isolated", "2-3");
    put("sys/devices/system/cpu/nohz_full", "3");
    put("proc/cmdline", "quiet rcu_nocbs=1,3 nohz_full=3");
    put("sys/devices/system/cpu/cpu3/cpufreq/scaling_governor", "performance");
    put("sys/devices/system/cpu/cpu3/cpuidle/state1/latency", "10");
    put("sys/devices/system/cpu/cpu3/cpuidle/state1/disable", "0");
    put("sys/devices/system/clocksource/clocksource0/current_clocksource", "tsc");
    put("proc/net/route",
        "Iface\tDestination\tGateway \tFlags\tRefCnt\tUse\tMetric\tMask\t\tMTU\tWindow\tIRTT\n"
        "eth0\t00000000\t0100A8C0\t0003\t0\t0\t0\t00000000\t0\t0\t0\n"
        "lo\t000000E0\t00000000\t0001\t0\t0\t0\t000000F0\t0\t0\t0");
    put("proc/sys/net/core/rmem_max", "4194304");
    put("proc/sys/kernel/sched_rt_runtime_us", "-1");
  }

  std::string folder, details;
  Machine machine;
};

TEST_F(MachineTest, AGoodMachineIsGoodInEveryRow) {
  put_good_machine();
  for (const auto& check : check_machine(machine, 3)) EXPECT_EQ(check.grade, Grade::kOk) << check.what << check.found;
}

TEST_F(MachineTest, EachFlawIsFoundInItsRowWithARemedy) {
  const struct {
    const char *file, *text, *row;
    Grade grade;
  } flaws[] = {
      {"sys/kernel/realtime", "0", "kernel", Grade::kFail},
      {"proc/self/limits", "Max locked memory         65536   unlimited   bytes", "locked memory", Grade::kFail},
      {"proc/self/limits", "Max realtime priority     0   0", "real-time priority", Grade::kFail},
      {"sys/devices/system/cpu/isolated", "1-2", "own core", Grade::kWarn},
      {"sys/devices/system/cpu/nohz_full", "(null)", "timer ticks", Grade::kWarn},
      {"proc/cmdline", "quiet", "RCU callbacks", Grade::kWarn},
      {"sys/devices/system/cpu/cpu3/cpufreq/scaling_governor", "powersave", "frequency", Grade::kWarn},
      {"sys/devices/system/cpu/cpu3/cpuidle/state1/latency", "133", "idle states", Grade::kWarn},
      {"sys/devices/system/clocksource/clocksource0/current_clocksource", "hpet", "clock source", Grade::kWarn},
      {"proc/sys/kernel/sched_rt_runtime_us", "950000", "real-time share", Grade::kWarn},
      {"proc/net/route", "Iface", "LCM multicast", Grade::kFail},
      {"proc/sys/net/core/rmem_max", "212992", "receive buffer", Grade::kWarn},
  };
  for (const auto& flaw : flaws) {
    put_good_machine();
    put(flaw.file, flaw.text);
    EXPECT_EQ(grade(check_machine(machine, 3), flaw.row), flaw.grade) << flaw.row;
  }
}

// From Linux 6.12 on the sysctl no longer limits real-time threads. The fair server of each core does.
TEST_F(MachineTest, TheFairServerOfTheCoreDecides) {
  const auto share = [&](const char* kernel) {
    put("proc/sys/kernel/osrelease", kernel);
    return grade(check_machine(machine, 3), "real-time share");
  };
  put_good_machine();
  for (const char* old : {"6.1.0-rt", "6.11.9", "5.10.0"}) EXPECT_EQ(share(old), Grade::kOk) << old;
  for (const char* present : {"6.12.57-rt", "6.18.44", "7.0"}) EXPECT_EQ(share(present), Grade::kWarn) << present;
  put("sys/kernel/debug/sched/fair_server/cpu0/runtime", "0");  // another core
  EXPECT_EQ(share("6.12.57"), Grade::kWarn);
  put("sys/kernel/debug/sched/fair_server/cpu3/runtime", "50000000");
  EXPECT_EQ(share("6.12.57"), Grade::kWarn);
  put("sys/kernel/debug/sched/fair_server/cpu3/runtime", "0");
  put("proc/sys/kernel/sched_rt_runtime_us", "950000");
  EXPECT_EQ(share("6.12.57"), Grade::kOk);
}

TEST_F(MachineTest, CapabilitiesStandInForLimits) {
  put("proc/self/status", "Name:\tx\nCapEff:\t0000000000804000");
  const auto checks = check_machine(machine, 0);
  EXPECT_EQ(grade(checks, "real-time priority"), Grade::kOk);
  EXPECT_EQ(grade(checks, "locked memory"), Grade::kOk);
}

TEST_F(MachineTest, AnEmptyMachineIsReadWithoutHarm) {
  EXPECT_EQ(grade(check_machine(machine, 0), "kernel"), Grade::kFail);
  EXPECT_EQ(check_can(machine, "can0", 0).at(0).grade, Grade::kFail);
}

TEST_F(MachineTest, CanInterfaces) {
  put("sys/class/net/can0/flags", "0x40081");
  put("sys/class/net/can0/tx_queue_len", "8");
  put("proc/interrupts", "           CPU0       CPU1\n 17:   5   6   IO-APIC   17-fasteoi   can0");
  put("proc/irq/17/smp_affinity_list", "0");
  details = "can state ERROR-ACTIVE \n\t bitrate 1000000 sample-point 0.800 \n";
  for (const auto& check : check_can(machine, "can0", 1)) EXPECT_EQ(check.grade, Grade::kOk) << check.what;
  put("proc/interrupts", " 17:   5   6   IO-APIC   17-fasteoi   can0\n 18:   5   6   IO-APIC   18-fasteoi   can0");
  put("proc/irq/18/smp_affinity_list", "1");
  EXPECT_EQ(grade(check_can(machine, "can0", 1), "CAN interrupt"), Grade::kWarn) << "the second of two interrupts";
  put("proc/irq/18/smp_affinity_list", "0");
  EXPECT_EQ(grade(check_can(machine, "can0", 1), "CAN interrupt"), Grade::kOk);
  details = "can state BUS-OFF \n\t bitrate 1000000 sample-point 0.800 \n";
  EXPECT_EQ(grade(check_can(machine, "can0", 1), "CAN"), Grade::kFail) << "up, and yet off the bus";
  details = "can state ERROR-ACTIVE \n\t bitrate 500000 sample-point 0.875 \n";
  put("sys/class/net/can0/flags", "0x40080");
  put("sys/class/net/can0/tx_queue_len", "64");  // old torques would wait in such a long queue
  put("proc/irq/17/smp_affinity_list", "0-3");
  const auto checks = check_can(machine, "can0", 1);
  EXPECT_EQ(grade(checks, "CAN"), Grade::kFail);
  EXPECT_EQ(grade(checks, "CAN bit rate"), Grade::kFail);
  EXPECT_EQ(grade(checks, "CAN queue"), Grade::kWarn);
  EXPECT_EQ(grade(checks, "CAN interrupt"), Grade::kWarn);
  put("sys/class/net/can0/tx_queue_len", "5");  // shorter than the frames of a period
  EXPECT_EQ(grade(check_can(machine, "can0", 1), "CAN queue"), Grade::kWarn);
}

TEST_F(MachineTest, DrivesThatSpeakFdNeedItsDataRate) {
  put("sys/class/net/can0/flags", "0x40081");
  put("sys/class/net/can0/mtu", "72");
  details =
      "can <FD> state ERROR-ACTIVE \n bitrate 1000000 sample-point 0.800 \n dbitrate 5000000 dsample-point 0.75\n";
  EXPECT_EQ(grade(check_can(machine, "can0", 1, true), "CAN FD"), Grade::kOk);
  details =
      "can <FD> state ERROR-ACTIVE \n bitrate 1000000 sample-point 0.800 \n dbitrate 2000000 dsample-point 0.75\n";
  EXPECT_EQ(grade(check_can(machine, "can0", 1, true), "CAN FD"), Grade::kFail);
  put("sys/class/net/can0/mtu", "16");
  details = "can state ERROR-ACTIVE \n bitrate 1000000 sample-point 0.800 \n";
  EXPECT_EQ(grade(check_can(machine, "can0", 1, true), "CAN FD"), Grade::kFail);
  for (const auto& check : check_can(machine, "can0", 1)) EXPECT_NE(check.what, "CAN FD");
}

TEST(Machine, ReadsCoreListsAndRoutes) {
  EXPECT_TRUE(list_holds("0,2-5", 4));
  EXPECT_FALSE(list_holds("0,2-5", 1));
  EXPECT_FALSE(list_holds("", 0));
  const std::string table = "head\neth0\t00000000\t0\t3\t0\t0\t0\t00000000\t0\t0\t0\n";
  EXPECT_EQ(route_of(table, 0xEFFF4C43), "eth0");
  EXPECT_EQ(route_of("head\n", 0xEFFF4C43), "");
  // The loopback network 127.0.0.0/8 is no route to 239.255.76.67, however specific; of two routes the more specific is
  // used, in any order of lines.
  const std::string any = "eth0\t00000000\t0101A8C0\t0003\t0\t0\t0\t00000000\n",
                    loop = "lo\t0000007F\t00000000\t0001\t0\t0\t0\t000000FF\n",
                    many = "eth1\t000000E0\t00000000\t0001\t0\t0\t0\t000000F0\n";
  EXPECT_EQ(route_of("head\n" + any + loop, 0xEFFF4C43), "eth0");
  EXPECT_EQ(route_of("head\n" + loop, 0xEFFF4C43), "");
  EXPECT_EQ(route_of("head\n" + any + many + loop, 0xEFFF4C43), "eth1");
  EXPECT_EQ(route_of("head\n" + loop + many + any, 0xEFFF4C43), "eth1");
}

TEST_F(MachineTest, ASecondHardwareThreadOfTheCoreIsFound) {
  const std::string file = "sys/devices/system/cpu/cpu3/topology/thread_siblings_list";
  EXPECT_EQ(grade(check_core(machine, 3), "sibling thread"), Grade::kOk);  // a kernel that does not tell
  put(file, "3");
  EXPECT_EQ(grade(check_core(machine, 3), "sibling thread"), Grade::kOk);
  for (const char* shared : {"3,7", "2-3"}) {
    put(file, shared);
    EXPECT_EQ(grade(check_core(machine, 3), "sibling thread"), Grade::kWarn) << shared;
  }
}

TEST_F(MachineTest, InterruptThreadsAboveTheLoopAreFound) {
  const auto stat = [](const char* name, int priority) {  // proc(5): priority is field 40, policy field 41
    std::string line = std::string("77 (") + name + ") S";
    for (int field = 4; field < 40; ++field) line += " 0";
    return line + " " + std::to_string(priority) + " 1 0";
  };
  put("proc/77/comm", "irq/19-can0");
  put("proc/77/stat", stat("irq/19-can0", 50));
  put("proc/78/comm", "other");
  put("proc/78/stat", stat("other", 99));
  EXPECT_EQ(grade(check_core(machine, 3), "interrupt threads"), Grade::kOk);
  put("proc/77/comm", "irq/19 a) b");
  put("proc/77/stat", stat("irq/19 a) b", 80));
  const auto checks = check_core(machine, 3);
  EXPECT_EQ(grade(checks, "interrupt threads"), Grade::kWarn);
  EXPECT_NE(checks[1].remedy.find("77"), std::string::npos);
  put("proc/77/stat", "77 (irq/19 a) b) S 1 2");  // cut off
  EXPECT_EQ(grade(check_core(machine, 3), "interrupt threads"), Grade::kOk);
}

}  // namespace
}  // namespace ligature::platform
