// One hand with moteus drives, with hand-made frames: queries, answers, torques, and how the drives are switched on and
// off.
#include "firmware/platform/moteus_link.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <optional>
#include <vector>

#include "firmware/platform/make_drives.hpp"
#include "firmware/platform/moteus_drives.hpp"
#include "firmware/platform/moteus_time.hpp"
#include "protocol/device/device_file.hpp"
#include "tests/support/random.hpp"
#include "tests/unit/platform/fake_bus.hpp"

namespace ligature::platform {
namespace {

constexpr std::uint8_t kOff = 0, kPreparing = 3, kFixedVoltage = 6, kOn = 10, kTimeout = 11;
using rt::DriveRequest;

std::vector<std::uint8_t> bytes_of(const can::Frame& f) { return {f.data.begin(), f.data.begin() + f.dlc}; }

/// Bytes that the maker's Python package 1.1.1 makes for the same; Drives.Moteus compares every frame of a run with it.
TEST(MoteusFrames, AreThoseOfTheMakersPackage) {
  const can::Frame torque = moteus::torque(2, 0.25F, {0.9F, 0.02F});
  EXPECT_EQ(torque.id, 0x002U);
  EXPECT_EQ(torque.format, can::Format::kFdFast);
  EXPECT_EQ(bytes_of(torque),
            (std::vector<std::uint8_t>{0x01, 0x00, 0x0A, 0x01, 0x20, 0x80, 0x0D, 0x22, 0x00, 0x00, 0x80,
                                       0x3E, 0x02, 0x23, 0x00, 0x00, 0x0D, 0x25, 0x66, 0x66, 0x66, 0x3F,
                                       0x0D, 0x27, 0x0A, 0xD7, 0xA3, 0x3C, 0x01, 0x2B, 0x00, 0x50}));
  EXPECT_EQ(bytes_of(moteus::stop(1)), (std::vector<std::uint8_t>{0x01, 0x00, 0x00}));
  const can::Frame query = moteus::query(3, moteus::Extra::kWatchdog);
  EXPECT_EQ(query.id, can::kExtendedBit | 0x8003U) << "bit 15: an answer is wanted";
  EXPECT_EQ(bytes_of(query),
            (std::vector<std::uint8_t>{0x11, 0x00, 0x1D, 0x01, 0x1D, 0x03, 0x11, 0x0F, 0x1D, 0x27, 0x50, 0x50}));
}

/// An answer of the form that the query asks for.
can::Frame answer(unsigned node, std::uint8_t mode, float rev, moteus::Extra extra, float value, std::uint8_t fault = 0,
                  float torque_Nm = 0.0F) {
  can::Frame f{node << 8U,
               24,
               {0x21, 0x00, mode, 0x2D, 0x01, 0, 0, 0, 0, 0x2D, 0x03, 0, 0, 0, 0, 0x21, 0x0F, fault, 0x2D},
               can::Format::kFdFast};
  f.data[19] = moteus::kExtraRegister[static_cast<std::size_t>(extra)];
  for (const auto& [at, number] : {std::pair{5U, rev}, {11U, torque_Nm}, {20U, value}})
    for (unsigned i = 0; i < 4; ++i)
      f.data[at + i] = static_cast<std::uint8_t>(std::bit_cast<std::uint32_t>(number) >> (8U * i));
  return f;
}

class Moteus : public ::testing::Test {
 protected:
  static constexpr int kWatchdog_ms = 20;
  /// What a healthy drive tells back.
  float told(moteus::Extra extra) const {
    if (extra == moteus::Extra::kHome) return 1.0F;
    if (extra == moteus::Extra::kMaxTorque) return static_cast<float>(device.max_torque_Nm());
    return extra == moteus::Extra::kWatchdog ? 0.02F : 0.0F;
  }
  /// The extra register of the queries that were sent last; nothing if nobody was asked.
  std::optional<moteus::Extra> asked() const {
    for (const can::Frame& f : bus.sent)
      for (std::size_t i = 0; i < moteus::kExtras; ++i)
        if (f == moteus::query(1, static_cast<moteus::Extra>(i))) return static_cast<moteus::Extra>(i);
    return std::nullopt;
  }
  /// The module answers the queries that were sent last.
  void press() {
    last_life = life.value_or(moteus::register_of(*asked()));
    bus.inbox.push_back({moteus::kButtonsId, 2, {2, last_life}});
  }
  /// One period in which the drives answer.
  rt::HandReading period(DriveRequest request, double torque_Nm = 0.0) {
    bus.sent.clear();
    link->request();
    if (const auto extra = asked()) {
      for (unsigned node = 1; node <= 3; ++node)
        bus.inbox.push_back(answer(node, mode[node - 1], rev, *extra, change ? change(node, *extra) : told(*extra),
                                   fault[node - 1], made_Nm));
      press();
    }
    link->drain();
    const auto reading = link->reading();
    bus.sent.clear();
    sent = link->write({{torque_Nm, torque_Nm, torque_Nm}, request});
    return reading;
  }
  rt::HandReading periods(int n, DriveRequest request, double torque_Nm = 0.0) {
    rt::HandReading r;
    for (int i = 0; i < n; ++i) r = period(request, torque_Nm);
    return r;
  }
  void set_modes(std::uint8_t m) { mode = {m, m, m}; }
  /// Until all drives are on and have told back their settings.
  void switch_on() {
    set_modes(kOff);
    periods(3, DriveRequest::kEnable);
    set_modes(kOn);
    ASSERT_TRUE(periods(8, DriveRequest::kEnable).enabled);
  }
  bool all_stopped() const {
    return bus.sent.size() == 3 &&
           std::ranges::all_of(bus.sent, [](const can::Frame& f) { return bytes_of(f) == bytes_of(moteus::stop(1)); });
  }
  FakeBus bus;
  device::Device device =
      std::get<device::Device>(device::load_device(std::string(LIGATURE_SOURCE_DIR) + "/scenes/devices/moteus.toml"));
  std::optional<MoteusLink> link{std::in_place, bus, device, kWatchdog_ms};
  std::array<std::uint8_t, 3> mode{}, fault{};
  std::function<float(unsigned, moteus::Extra)> change;  // of what the drives tell back
  float rev = 0.5F, made_Nm = 0.0F;
  std::uint8_t last_life = 0;
  std::optional<std::uint8_t> life;  // counter of a module that does not tell the register that was asked for
  std::array<std::int16_t, 3> sent{};
};

TEST_F(Moteus, TakesRevolutionsTorqueAndButtons) {
  made_Nm = 0.125F;
  switch_on();
  const auto r = period(DriveRequest::kOperate, 0.3);
  EXPECT_EQ(r.age_ticks, 0);
  EXPECT_TRUE(r.valid && r.enabled && r.dead_man);
  EXPECT_FALSE(r.drive_fault || r.grip);
  EXPECT_DOUBLE_EQ(r.q_rad[1], std::numbers::pi) << "half a turn";
  EXPECT_EQ(r.measured_Nm[2], 0.125);
  EXPECT_TRUE(std::isnan(r.torque_Nm[0])) << "a measured torque is not the one that acts, to the last digit";
  EXPECT_EQ(sent, (std::array<std::int16_t, 3>{1000, 1000, 1000}));
  EXPECT_EQ(bus.sent[1], moteus::torque(2, 0.3F, {0.9F, 0.02F}));
}

/// A drive gets no torque before it has told back everything that it was commanded, and none after another answer: it
/// may have started anew, or have lost the command.
TEST_F(Moteus, NoTorqueUnlessEverySettingIsToldBack) {
  for (std::size_t i = 0; i < moteus::kExtras; ++i) {
    for (const bool later : {false, true}) {
      link.emplace(bus, device, kWatchdog_ms);
      const auto wrong = static_cast<moteus::Extra>(i);
      change = nullptr;
      set_modes(kOff);
      periods(10, DriveRequest::kHold);
      if (later) switch_on();
      change = [&](unsigned node, moteus::Extra extra) { return node == 2 && extra == wrong ? 0.5F : told(extra); };
      set_modes(kOff);
      if (!later) periods(3, DriveRequest::kEnable);
      set_modes(kOn);
      for (int k = 0; k < 30; ++k) {
        const auto r = period(later ? DriveRequest::kOperate : DriveRequest::kEnable, 0.3);
        ASSERT_FALSE(r.enabled && !later) << i;
        ASSERT_TRUE(all_stopped() || !r.drive_fault) << i;
        if (r.drive_fault) break;
        ASSERT_LT(k, 12) << i << later;
        EXPECT_TRUE(later || sent[0] == 0);
      }
    }
  }
}

TEST_F(Moteus, NoTorqueInTheFirstPeriodsWhateverIsAsked) {
  set_modes(kOff);
  periods(3, DriveRequest::kEnable);
  set_modes(kPreparing);
  for (int k = 0; k < 5; ++k) {
    EXPECT_FALSE(period(DriveRequest::kOperate, 0.3).enabled);
    EXPECT_EQ(sent[0], 0);
    EXPECT_EQ(bus.sent[0], moteus::torque(1, 0.0F, {0.9F, 0.02F}));
  }
  set_modes(kOn);
  for (int k = 0; k < 5; ++k) {
    (void)period(DriveRequest::kEnable);
    EXPECT_FALSE(link->reading().enabled) << "only some of the settings are told back";
  }
  EXPECT_TRUE(period(DriveRequest::kEnable).enabled);
  EXPECT_EQ(sent[0], 0) << "not before the control law wants to operate";
}

/// A drive that is on must say so in each answer. Any other mode is a fault at once, and all drives are stopped.
TEST_F(Moteus, AnyOtherModeIsAFaultAtOnce) {
  for (std::uint8_t other = 0; other <= 15; ++other) {
    if (other == kOn) continue;
    switch_on();
    (void)period(DriveRequest::kOperate, 0.3);
    mode[1] = other;
    EXPECT_TRUE(period(DriveRequest::kOperate, 0.3).drive_fault) << int{other};
    EXPECT_TRUE(all_stopped()) << int{other};
    mode[1] = kOn;  // as if nothing had been
    EXPECT_FALSE(period(DriveRequest::kOperate, 0.3).enabled) << int{other};
    EXPECT_TRUE(all_stopped()) << int{other};
    set_modes(kOff);
    periods(60, DriveRequest::kHold);
  }
}

/// A drive that damps makes a torque that nobody commanded. That is the fault of its mode, which a reset clears.
TEST_F(Moteus, TheTorqueOfTheDampingIsNoTorqueAstray) {
  switch_on();
  made_Nm = 0.4F;
  mode[0] = kTimeout;
  const auto r = period(DriveRequest::kOperate);
  EXPECT_TRUE(std::isnan(r.measured_Nm[0]));
  EXPECT_NEAR(r.measured_Nm[1], 0.4, 1e-6);
  EXPECT_TRUE(r.drive_fault);
}

/// Also in an answer that is late, and so no sample.
TEST_F(Moteus, AnotherModeInALateAnswerIsAFault) {
  switch_on();
  bus.sent.clear();
  link->request();
  link->write({{}, DriveRequest::kOperate});
  link->request();
  bus.inbox.push_back(answer(2, kFixedVoltage, 0.0F, moteus::Extra::kHome, 1.0F));
  link->drain();
  EXPECT_GE(link->reading().age_ticks, 2);
  EXPECT_TRUE(link->reading().drive_fault);
}

TEST_F(Moteus, FaultsAreFaultsAndLimitsAreLimits) {
  for (int number = 1; number < 128; ++number) {
    switch_on();
    fault[2] = static_cast<std::uint8_t>(number);
    const auto r = period(DriveRequest::kOperate, 0.1);
    const bool is_limit = number >= 96 && number <= 103;
    EXPECT_EQ(r.drive_fault, !is_limit) << number;
    EXPECT_EQ(r.torque_limited[2], is_limit) << number;
    EXPECT_FALSE(r.torque_limited[1]);
    fault[2] = 0;
    set_modes(kOff);
    periods(60, DriveRequest::kHold);
  }
}

/// Only the answer to a query that came after the stop says that a drive is off.
TEST_F(Moteus, ADriveIsOffOnlyIfItSaysSoAfterTheStop) {
  for (const bool is_refused : {false, true}) {
    switch_on();
    (void)period(DriveRequest::kOperate, 0.3);
    set_modes(kOff);  // by themselves, before the stop
    bus.sent.clear();
    link->request();
    const auto extra = *asked();
    for (unsigned node = 1; node <= 3; ++node) bus.inbox.push_back(answer(node, kOff, rev, extra, told(extra)));
    press();
    link->drain();
    if (is_refused) bus.refuse_at = 1;  // the stop to node 2
    link->write({{}, DriveRequest::kHold});
    EXPECT_FALSE(link->nodes()[0].is_off);
    EXPECT_EQ(link->reading().bus_lost, is_refused);
    period(DriveRequest::kHold);
    EXPECT_TRUE(link->nodes()[0].is_off);
    EXPECT_EQ(link->nodes()[1].is_off, !is_refused) << "a refused stop is no stop";
    EXPECT_TRUE(all_stopped()) << "it is sent again";
    period(DriveRequest::kHold);
    EXPECT_TRUE(link->nodes()[1].is_off);
    periods(60, DriveRequest::kHold);
  }
}

/// A reset of the fault waits until all drives are off. Meanwhile they get stops, which feed no watchdog.
TEST_F(Moteus, AResetWaitsUntilAllDrivesAreOff) {
  switch_on();
  mode = {kOff, kTimeout, kOff};
  for (int k = 0; k < 80; ++k) {
    (void)period(k < 60 ? DriveRequest::kHold : DriveRequest::kEnable);
    EXPECT_TRUE(all_stopped()) << k;
  }
  switch_on();
}

TEST_F(Moteus, ADriveThatForgotItsPositionStaysOffUntilARestart) {
  switch_on();
  set_modes(kOff);
  periods(10, DriveRequest::kHold);
  change = [this](unsigned node, moteus::Extra extra) {
    return node == 3 && extra == moteus::Extra::kHome ? 2.0F : told(extra);
  };
  periods(6, DriveRequest::kHold);
  change = nullptr;
  for (int k = 0; k < 100; ++k) {
    EXPECT_TRUE(period(DriveRequest::kEnable).drive_fault) << k;
    ASSERT_TRUE(all_stopped()) << k;
  }
}

/// Answers are late by any number of periods, or always by the same: those of all, of the module, or of one drive. An
/// old pose or an old dead-man must never count as new. If answers are later than any sample may be, sets come so
/// seldom that their age is fault 11.
TEST_F(Moteus, ALateAnswerIsNoNewSample) {
  constexpr int kRandom = -1, kPeriods = 2000, kTooOld = 20;
  test::Random random(15);
  struct Late {
    int due;
    can::Frame frame;
  };
  for (const unsigned who : {0xFU, 0x8U, 0x2U}) {
    for (int always = kRandom; always <= 2 * kTooOld + 5; ++always) {
      link.emplace(bus, device, kWatchdog_ms);
      std::vector<Late> under_way;
      std::array<int, 5> due{};
      int fresh = 0, last = -kTooOld - 1;
      for (int k = 0; k < kPeriods; ++k) {
        bus.sent.clear();
        link->request();
        const auto bits = static_cast<std::uint8_t>(random.any(0, 7));
        if (const auto extra = asked()) {
          for (unsigned node = 1; node <= 4; ++node) {  // 4: the button module
            const int late = (who >> (node - 1U) & 1U) == 0U ? 0
                             : always >= 0                   ? always
                                           : static_cast<int>(random.happens(0.2) ? random.any(1, 4) : 0);
            can::Frame f = answer(node, kOff, static_cast<float>(k), *extra, told(*extra));
            if (node == 4) f = {moteus::kButtonsId, 2, {bits, moteus::register_of(*extra)}};
            due[node] = std::max(due[node], k + late);  // answers of a node keep their order
            under_way.push_back({due[node], f});
          }
        }
        for (const Late& a : under_way)
          if (a.due == k) bus.inbox.push_back(a.frame);
        std::erase_if(under_way, [k](const Late& a) { return a.due <= k; });
        link->drain();
        const auto r = link->reading();
        if (r.age_ticks != 0) continue;
        ++fresh;
        if (always > kTooOld) {
          ASSERT_GT(k - last, kTooOld) << always << who;
          last = k;
          continue;
        }
        for (const double q : r.q_rad) ASSERT_EQ(q, static_cast<float>(k) * 2.0 * std::numbers::pi) << k;
        ASSERT_EQ((r.grip ? 1 : 0) | (r.dead_man ? 2 : 0) | (r.clutch ? 4 : 0), bits) << k << always << who;
      }
      EXPECT_TRUE(always > 0 ? always > kTooOld || fresh == 0 : fresh > 150) << fresh << always << who;
    }
  }
}

/// Answers that the loop no longer waits for, but that come before the next queries, are samples that are one period
/// old.
TEST_F(Moteus, AnAnswerJustBeforeTheNextQueryIsOnePeriodOld) {
  switch_on();
  for (int k = 0; k < 50; ++k) {
    bus.sent.clear();
    link->request();
    const auto extra = asked();
    ASSERT_TRUE(extra);
    link->drain();
    const auto r = link->reading();
    EXPECT_EQ(r.age_ticks, 1) << k;
    EXPECT_EQ(r.q_rad[0], (k == 0 ? rev : static_cast<float>(k - 1)) * 2.0 * std::numbers::pi);
    EXPECT_FALSE(r.drive_fault);
    for (unsigned node = 1; node <= 3; ++node)
      bus.inbox.push_back(answer(node, kOn, static_cast<float>(k), *extra, told(*extra)));
    press();
    link->write({{}, DriveRequest::kOperate});
  }
}

/// Answers keep their order, so after a new one the missing ones are lost, and excuse no answer to nothing. Nor does it
/// matter how many are missing.
TEST_F(Moteus, ADriveThatWasAwayExcusesNothing) {
  for (const int away : {2, 8, 30, 200}) {
    link.emplace(bus, device, kWatchdog_ms);
    set_modes(kOff);
    periods(3, DriveRequest::kHold);
    for (int k = 0; k < away; ++k) {
      link->request();
      link->write({{}, DriveRequest::kHold});
    }
    periods(25, DriveRequest::kHold);
    EXPECT_FALSE(period(DriveRequest::kHold).drive_fault) << away;
    EXPECT_EQ(link->reading().age_ticks, 0) << away;
    bus.sent.clear();
    link->request();
    const auto extra = *asked();
    for (int i = 0; i < 2; ++i) bus.inbox.push_back(answer(1, kOff, 0.0F, extra, told(extra)));
    link->drain();
    EXPECT_TRUE(link->reading().drive_fault) << away;
  }
}

TEST_F(Moteus, AnAnswerThatNobodyAskedForIsAFault) {
  switch_on();
  bus.inbox.push_back(answer(1, kOn, 0.9F, moteus::Extra::kHome, 1.0F));
  link->drain();
  EXPECT_NE(link->reading().q_rad[0], 0.9 * 2.0 * std::numbers::pi);
  EXPECT_TRUE(link->reading().drive_fault) << "two drives with one id";
}

/// A drive whose answers go on does not make the buttons alive: their own frame must name the register that was asked.
TEST_F(Moteus, ButtonsMustNameTheirRequest) {
  switch_on();
  life = last_life;
  for (int k = 0; k < 12; ++k) {
    const auto r = period(DriveRequest::kOperate, 0.1);
    EXPECT_EQ(r.age_ticks, k + 1) << "the same frame again, also when its register is asked for";
    EXPECT_EQ(r.buttons_stuck, k >= 9);
  }
  for (int k = 12; k < 24; ++k) {
    life = k % 2 == 0 ? 0x80 : 0x81;
    const auto r = period(DriveRequest::kOperate, 0.1);
    EXPECT_EQ(r.age_ticks, k + 1) << "a counter of its own";
    EXPECT_FALSE(r.buttons_stuck);
  }
}

/// Without its torque a drive's own torque would not be seen.
TEST_F(Moteus, ATorqueThatIsNoNumberIsAstray) {
  switch_on();
  EXPECT_FALSE(period(DriveRequest::kOperate).torque_astray);
  made_Nm = std::nanf("");
  EXPECT_TRUE(period(DriveRequest::kOperate).torque_astray);
  set_modes(kOff);
  EXPECT_FALSE(period(DriveRequest::kHold).torque_astray) << "a drive that is off makes none";
}

/// A drive whose encoder has failed still says its mode.
TEST_F(Moteus, WithoutAPositionTheModeCountsAndTheSampleDoesNot) {
  switch_on();
  rev = std::nanf("");
  for (int k = 0; k < 5; ++k) {
    const auto r = period(DriveRequest::kOperate);
    EXPECT_EQ(r.age_ticks, k + 1);
    EXPECT_DOUBLE_EQ(r.q_rad[0], std::numbers::pi);
    EXPECT_FALSE(r.drive_fault);
  }
  mode[1] = kFixedVoltage;
  EXPECT_TRUE(period(DriveRequest::kOperate).drive_fault);
  EXPECT_TRUE(all_stopped());
}

/// The honest answer must not become one to nothing.
TEST_F(Moteus, AFrameThatIsNoAnswerStrikesNoRequestOff) {
  switch_on();
  can::Frame other = answer(1, kOn, 0.0F, moteus::Extra::kHome, 1.0F);
  other.id |= can::kExtendedBit;
  for (const can::Frame& f : {other, can::Frame{0x100, 3, {0x21, 0x00, kOn}, can::Format::kFdFast}}) {
    bus.on_send = [&](const can::Frame& sent_now) {  // it comes after the query and before the answer
      if (sent_now.id == moteus::query(1, {}).id) bus.inbox.push_back(f);
    };
    const auto r = period(DriveRequest::kOperate);
    EXPECT_EQ(r.age_ticks, 0);
    EXPECT_FALSE(r.drive_fault);
  }
}

TEST_F(Moteus, ARefusedTorqueIsALostBus) {
  switch_on();
  bus.refuse_at = 4;  // of three queries and three torques
  (void)period(DriveRequest::kOperate, 0.3);
  EXPECT_EQ(sent, (std::array<std::int16_t, 3>{1000, 0, 1000}));
  EXPECT_TRUE(link->reading().bus_lost);
}

TEST_F(Moteus, FramesOfAnotherControllerStopTheDrives) {
  const auto to = [](std::uint32_t id, std::vector<std::uint8_t> bytes) {
    can::Frame f{id, static_cast<std::uint8_t>(bytes.size()), {}, can::Format::kFdFast};
    std::ranges::copy(bytes, f.data.begin());
    return f;
  };
  EXPECT_EQ(moteus::foreign_kind(moteus::torque(2, 0.1F, {})), rt::Foreign::kTorque);
  EXPECT_EQ(moteus::foreign_kind(moteus::query(2, {})), rt::Foreign::kBeat);
  EXPECT_EQ(moteus::foreign_kind(moteus::stop(2)), rt::Foreign::kNetwork);
  EXPECT_EQ(moteus::foreign_kind(to(0x501, {0x40, 0x01, 0x00})), rt::Foreign::kObject) << "a diagnostic text";
  EXPECT_EQ(moteus::foreign_kind(to(can::kExtendedBit | 0x827F, {0x0D})), rt::Foreign::kTorque) << "to all";
  EXPECT_EQ(moteus::foreign_kind(answer(1, kOn, 0.0F, {}, 0.0F)), rt::Foreign::kNone);
  EXPECT_EQ(moteus::foreign_kind({moteus::kButtonsId, 2, {}}), rt::Foreign::kNone);
  switch_on();
  bus.inbox.push_back(moteus::torque(2, 0.1F, {}));
  EXPECT_EQ(period(DriveRequest::kOperate, 0.3).foreign, rt::Foreign::kTorque);
  EXPECT_TRUE(all_stopped());
  set_modes(kOff);
  EXPECT_EQ(periods(100, DriveRequest::kEnable).foreign, rt::Foreign::kTorque);
  EXPECT_TRUE(all_stopped()) << "until a restart";
}

TEST_F(Moteus, AnAnswerOfAnotherFormIsNone) {
  const can::Frame good = answer(1, kOn, 0.25F, moteus::Extra::kKpScale, 0.0F);
  ASSERT_TRUE(moteus::read_reply(good));
  for (const std::size_t at : {0U, 1U, 3U, 4U, 9U, 10U, 15U, 16U, 18U, 19U}) {
    can::Frame bad = good;
    bad.data[at] = static_cast<std::uint8_t>(bad.data[at] ^ 0x40U);
    EXPECT_FALSE(moteus::read_reply(bad)) << at;
  }
  can::Frame shorter = good;
  shorter.dlc = 20;
  EXPECT_FALSE(moteus::read_reply(shorter));
}

/// What they do after it is stored in them, and is not read.
TEST_F(Moteus, HaveNoWatchdogThatIsChecked) { EXPECT_FALSE(have_watchdog(device)); }

/// Admission measures the reading of these frames, which must go as far as that of real ones.
TEST_F(Moteus, ExampleSamplesAreAnswers) {
  const auto frames = MoteusDrives(bus, device, kWatchdog_ms).example_samples();
  ASSERT_EQ(frames.size(), 4U);
  for (std::size_t j = 0; j < 3; ++j) {
    EXPECT_EQ(moteus::joint_of(frames[j]), j);
    EXPECT_TRUE(moteus::read_reply(frames[j]));
  }
}

TEST(MoteusTime, AllFramesOfAPeriodFit) {
  const auto most = moteus_time().samples_latest + moteus_torques_time();
  EXPECT_LT(most, rt::kPeriod);
  const can::Frame reply = answer(1, 0, 0.0F, moteus::Extra::kHome, 0.0F);
  EXPECT_EQ(reply.dlc, moteus::kReplyBytes);
  EXPECT_EQ(moteus::query(1, {}).dlc, moteus::kQueryBytes);
  EXPECT_EQ(moteus::torque(1, 0.0F, {}).dlc, moteus::kTorqueBytes);
  std::int64_t exact = 0;
  for (unsigned node = 1; node <= 3; ++node) exact += can::frame_ns(moteus::query(node, {})) + can::frame_ns(reply);
  exact += can::frame_ns({moteus::kButtonsId, 2, {}});
  EXPECT_GE(exact, moteus_time().samples_earliest.count());
  EXPECT_LE(exact, moteus_time().samples_latest.count());
  EXPECT_EQ(moteus_time().samples_latest.count() / 1000, 607);
  EXPECT_EQ(moteus_time().samples_earliest.count() / 1000, 514);
  EXPECT_EQ(moteus_torques_time().count() / 1000, 316);
}

}  // namespace
}  // namespace ligature::platform
