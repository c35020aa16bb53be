#pragma once
#include <array>
#include <cstdint>
#include <string_view>

#include "ligature_msg/tick_t.hpp"

namespace ligature::host {

inline constexpr std::array<std::string_view, 2> kHandNames{"left", "right"};

// Names for the numeric codes in messages, used by the host's programs and sent to the browser page at its start. A
// test compares each list with the firmware's.

inline constexpr std::array<std::string_view, 7> kStateNames{"OFF",   "CALIBRATE", "IDLE", "ENGAGE",
                                                             "FORCE", "BRAKE",     "FAULT"};

/// Name of a STATE_ value of tick_t; "?" for an invalid one.
[[nodiscard]] constexpr std::string_view state_name(std::int8_t state) {
  return state >= 0 && state < static_cast<std::int8_t>(kStateNames.size())
             ? kStateNames[static_cast<std::uint8_t>(state)]
             : "?";
}
static_assert(state_name(4) == "FORCE");

struct CodeName {
  int code;
  std::string_view name;
};

/// LIMIT_ bits of tick_t: the limits that reduced a hand's force.
inline constexpr std::array<CodeName, 7> kLimitNames{{{1, "peak force"},
                                                      {2, "motor heat"},
                                                      {4, "step"},
                                                      {8, "slew rate"},
                                                      {16, "hand too fast"},
                                                      {32, "passivity"},
                                                      {64, "joint torque"}}};

/// DEGRADED_ values of tick_t: the accuracy that the thread's solver gave up in a tick.
inline constexpr std::array<CodeName, 3> kDegradationNames{
    {{1, "iterations ended early: contacts softer"},
     {2, "too many contacts: shallowest only guarded"},
     {3, "too much is near: stood still for a part of the tick"}}};

/// PROPAGATION_ values of tick_t: the paper's condition (section IV) for the force on a hand.
inline constexpr std::array<CodeName, 3> kPropagationNames{{{1, "A: springs alone pass its force on"},
                                                            {2, "B: rigid segments pass its force on"},
                                                            {3, "C: rigid segments between both hands"}}};

struct FaultText {
  int number;
  std::string_view meaning, remedy;
};

/// Fault numbers (docs/architecture.md), what they mean, and what the operator should do.
inline constexpr std::array<FaultText, 19> kFaults{{
    {10, "A hand's bus is gone",
     "Check the cable, then reset the fault. If a simulated hand was started again, restart ligature-firmware."},
    {11, "Joint messages too old",
     "A drive stopped sending, or the machine was too slow. Check load and bus, then reset."},
    {12, "A drive reports a fault", "Read the drive's own error code, clear its cause, then reset."},
    {13, "Somebody else on the bus commands torque",
     "Take everything but this controller and the drives off the bus, then restart ligature-firmware."},
    {14, "Another controller is on the bus", "End the other controller, then restart ligature-firmware."},
    {15, "Somebody else on the bus starts or stops drives",
     "Take every other CANopen tool off the bus, then restart ligature-firmware."},
    {16, "Somebody else on the bus writes the drives' settings",
     "Take every other CANopen tool off the bus, then restart ligature-firmware, which writes them anew."},
    {17, "Too many of a hand's frames are lost",
     "Check that hand's cable, its terminators and the bus load, then reset."},
    {18, "A hand's joint messages stopped, then came in a burst",
     "Its drives, or the process of a simulated hand, stood still: lower the machine's load or start ligature-device "
     "with --rt. Then reset."},
    {20, "A force or position is not a number", "Reset the thread, then the fault. If it returns, soften the scene."},
    {21, "The hand moved too fast", "Hold the stylus still, then reset the fault."},
    {22, "An encoder stands still while the others move", "Check that joint's encoder and its cable, then reset."},
    {23, "A joint turned back at once while the others moved on",
     "Check that joint's encoder and its sign, then reset."},
    {24, "The stylus buttons cannot be trusted",
     "Check the buttons and their cable: no force without the dead-man. Then reset."},
    {25, "A hand's force did not end in time and was taken at once",
     "Look for frames lost in bursts, or a drive whose torque does not follow what it is sent. Then reset."},
    {26, "A drive makes a torque that nobody asked for",
     "Cut the drive's power and look for its cause (gains, wiring, another sender), then restart ligature-firmware."},
    {30, "The control loop lost periods", "Too much load on the machine: run ligature-firmware doctor, then reset."},
    {40, "The thread simulation diverged", "Reset the thread, then the fault. If it returns, soften the scene."},
    {41, "The thread simulation is late", "Reset the fault. If it returns, take a scene that this machine admits."},
}};

}  // namespace ligature::host
