// RigBus: the CAN traffic of both hands within one period.
#include "firmware/platform/rig_bus.hpp"

#include <array>
#include <memory>
#include <vector>

#include "firmware/platform/make_drives.hpp"
#include "protocol/can/emcy.hpp"
#include "protocol/can/heartbeat.hpp"
#include "protocol/can/nmt.hpp"
#include "protocol/can/sdo.hpp"
#include "protocol/can/units.hpp"
#include "tests/unit/platform/hand_link_fixture.hpp"

namespace ligature::platform {
namespace {

struct TwoHands {
  FakeBus left, right;
  FakeWait wait;
  std::array<std::unique_ptr<HandDrives>, 2> drives{make_drives(left, device::omni(), 20, 0),
                                                    make_drives(right, device::omni(), 20, 1)};
  RigBus rig{*drives[0], *drives[1], wait};
};

TEST(RigBus, ReturnsAsSoonAsBothHandsAnswered) {
  TwoHands hands;
  auto& [left, right, wait, drives, rig] = hands;
  rig.request();
  wait.on_wait = [&] {
    for (FakeBus* bus : {&left, &right}) {
      if (wait.time == Nanoseconds(bus == &left ? 200'000 : 400'000)) {
        for (const auto node : kNodes) bus->inbox.push_back(can::encode(node, can::Tpdo1{0x27, 0, 0, 0}));
      }
    }
  };
  const auto reading = rig.read(std::chrono::microseconds(600));
  EXPECT_EQ(wait.time, std::chrono::microseconds(400));
  EXPECT_EQ(reading.hand[0].age_ticks, 0);
  EXPECT_EQ(reading.hand[1].age_ticks, 0);
}

TEST(RigBus, EachHandHasItsOwnBus) {
  TwoHands hands;
  auto& [left, right, wait, drives, rig] = hands;
  rig.request();
  for (const auto node : kNodes) left.inbox.push_back(can::encode(node, can::Tpdo1{0x27, 10, 0, 0}));
  for (const auto node : kNodes) right.inbox.push_back(can::encode(node, can::Tpdo1{0x27, 20, 0, 0}));
  const auto reading = rig.read(std::chrono::microseconds(600));
  EXPECT_DOUBLE_EQ(reading.hand[0].q_rad[0], can::angle_rad(10));
  EXPECT_DOUBLE_EQ(reading.hand[1].q_rad[0], can::angle_rad(20));
  rt::RigCommand command;
  command.hand[0] = {{0.03, 0.0, 0.0}, rt::DriveRequest::kOperate};
  command.hand[1] = {{-0.06, 0.0, 0.0}, rt::DriveRequest::kHold};
  const auto sent = rig.write(command);
  EXPECT_EQ(sent[0][0], 100);
  EXPECT_EQ(sent[1][0], -200);
  const auto first_rpdo = [](const FakeBus& bus) {
    for (const auto& f : bus.sent)
      if (const auto rpdo = can::decode_rpdo1(kNodes[0], f)) return *rpdo;
    return can::Rpdo1{};
  };
  EXPECT_EQ(first_rpdo(left), (can::Rpdo1{can::cia402::kControlEnableOperation, 100}));
  EXPECT_EQ(first_rpdo(right), (can::Rpdo1{can::cia402::kControlDisableVoltage, -200}));
}

/// The heartbeat is sent when it cannot delay an answer to SYNC. The two hands' heartbeats fall in different periods.
TEST(RigBus, TheMastersHeartbeatGoesBeforeTheTorquesOfEveryFiftiethPeriod) {
  TwoHands hands;
  auto& [left, right, wait, drives, rig] = hands;
  std::vector<int> beats[2];
  for (int period = 0; period < 200; ++period) {
    for (FakeBus* bus : {&left, &right}) bus->sent.clear();
    rig.request();
    EXPECT_EQ(left.sent.size() + right.sent.size(), 2U) << "two SYNCs and nothing else";
    rt::RigCommand command;
    for (auto& hand : command.hand) hand.request = rt::DriveRequest::kEnable;
    (void)rig.write(command);
    for (FakeBus* bus : {&left, &right}) {
      if (bus->sent.size() == 4) continue;
      ASSERT_EQ(bus->sent.size(), 5U);
      EXPECT_EQ(bus->sent[1], can::encode(can::Heartbeat{can::kMasterNode, can::NmtState::kOperational}));
      beats[bus == &right].push_back(period);
    }
  }
  EXPECT_EQ(beats[0], (std::vector{0, 50, 100, 150}));
  EXPECT_EQ(beats[1], (std::vector{25, 75, 125, 175}));
}

TEST(RigBus, DoesNotWaitBeyondTheDeadline) {
  TwoHands hands;
  auto& [left, right, wait, drives, rig] = hands;
  rig.request();
  EXPECT_FALSE(rig.read(std::chrono::microseconds(600)).hand[0].valid);
  EXPECT_EQ(wait.time, std::chrono::microseconds(600));
}

}  // namespace
}  // namespace ligature::platform
