#pragma once
// One hand's link on a bus in memory, with drives whose answers the test sets.

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>

#include "firmware/platform/hand_link.hpp"
#include "protocol/can/device_profile.hpp"
#include "tests/unit/platform/fake_bus.hpp"

namespace ligature::platform {

using can::cia402::State;
inline constexpr auto kNodes = can::profile::kJointNodes;

class HandLinkTest : public ::testing::Test {
 protected:
  void answer(std::size_t joint, State state = State::kOperationEnabled, std::int32_t counts = 100,
              std::uint16_t buttons = 0) {
    bus.inbox.push_back(can::encode(kNodes[joint], can::Tpdo1{can::cia402::statusword_of(state), counts, 0, buttons}));
  }
  void answer_all(State state = State::kOperationEnabled, std::int32_t counts = 100, std::uint16_t buttons = 0) {
    for (std::size_t j = 0; j < 3; ++j) answer(j, state, counts, buttons);
  }
  rt::HandReading period() {
    link.send_sync();
    answer_all();
    link.drain();
    return link.reading();
  }
  can::Rpdo1 last_rpdo(std::size_t joint) const {
    for (auto f = bus.sent.rbegin(); f != bus.sent.rend(); ++f) {
      if (const auto rpdo = can::decode_rpdo1(kNodes[joint], *f)) return *rpdo;
    }
    return {};
  }
  FakeBus bus;
  HandLink link{bus, device::omni()};
};

}  // namespace ligature::platform
