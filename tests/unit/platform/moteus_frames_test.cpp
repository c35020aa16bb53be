// The frames of moteus drives and their time on the bus.
#include "firmware/platform/make_drives.hpp"
#include "firmware/platform/moteus_drives.hpp"
#include "firmware/platform/moteus_time.hpp"
#include "tests/unit/platform/moteus_hand_made.hpp"

namespace ligature::platform {
namespace {

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
