#include "protocol/can/hand_of_bus.hpp"

#include <gtest/gtest.h>

namespace ligature::can {
namespace {

TEST(HandOfBus, DoubtsABusThatIsNamedAfterTheOtherHandOnly) {
  EXPECT_EQ(doubt_about_hand("left", "local:/tmp/right"),
            "the bus local:/tmp/right of the left hand is named after the right one: are the hands swapped?");
  EXPECT_NE(doubt_about_hand("right", "socketcan:can_left"), "");
  for (const char* bus : {"local:/tmp/left", "socketcan:vcan0", "local:/home/wright/bus", "local:/tmp/left-of-right"})
    EXPECT_EQ(doubt_about_hand("left", bus), "") << bus;
}

}  // namespace
}  // namespace ligature::can
