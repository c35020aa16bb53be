// Which answers of moteus drives and of the button module are samples: late, old and unasked ones, with hand-made
// frames.
#include <algorithm>
#include <numbers>

#include "tests/support/random.hpp"
#include "tests/unit/platform/moteus_hand_made.hpp"

namespace ligature::platform {
namespace {

/// While nobody is asked, too, the missing part is the one that has not answered.
TEST(AnswerSet, NamesThePartThatDoesNotAnswer) {
  for (std::size_t silent = 0; silent < AnswerSet::kParts; ++silent) {
    AnswerSet answers;
    for (int k = 0; k < 25; ++k) {
      const bool asks = answers.begin_period(true);
      for (std::size_t part = 0; asks && part < AnswerSet::kParts; ++part) answers.asked(part);
      for (std::size_t part = 0; asks && part < AnswerSet::kParts; ++part) {
        if (part != silent && answers.take(part) == AnswerSet::Answer::kInTime) answers.add(part);
      }
      for (std::size_t part = 0; part < AnswerSet::kParts; ++part)
        EXPECT_EQ(answers.is_missing(part), part == silent) << part << " in period " << k;
    }
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

}  // namespace
}  // namespace ligature::platform
