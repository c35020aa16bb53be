#pragma once
// Brings the three drives of a hand from power-on to cyclic operation. Runs before the real-time loop and has no
// deadlines.

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "firmware/platform/bus_wait.hpp"
#include "firmware/platform/can_bus.hpp"
#include "protocol/can/sdo.hpp"
#include "protocol/can/startup.hpp"

namespace ligature::platform {

/// One expedited SDO transfer: sends the request and waits for its answer; other frames are skipped.
struct SdoAnswer {
  /// Empty: no answer in time, another controller was heard, or the bus is lost
  std::optional<can::Sdo> sdo;
  std::optional<std::string> other_master{};  ///< description of another controller that was heard meanwhile
};
[[nodiscard]] SdoAnswer transfer(CanBus& bus, BusWait& wait, const can::Frame& request, Nanoseconds patience);

/// Puts the nodes into pre-operational, checks that rated torque and encoder resolution match the unit conversions, and
/// writes startup_plan() (mapping, watchdogs, torque limit, cyclic synchronous torque mode). Then waits until the
/// drives show that mode.
/// @param lacks gets one line for each optional object that a drive does not have
/// @return one line that says why it failed, or nothing. The nodes are left in pre-operational, where no torque is
/// possible.
[[nodiscard]] std::optional<std::string> configure_drives(CanBus& bus, BusWait& wait, const can::StartupTimes& times,
                                                          std::vector<std::string>* lacks = nullptr,
                                                          Nanoseconds patience = std::chrono::milliseconds(500));

/// NMT start: from now on the drives answer SYNC with TPDOs. They stay switched off until enabled by controlword.
bool start_drives(CanBus& bus) noexcept;

/// End of a run: NMT pre-operational, in which drives are disabled and expect no RPDOs. Then each drive's monitoring of
/// our heartbeat is switched off, so that our silence causes no fault. A drive that does not report to be off keeps its
/// monitoring: our silence then ends its torque.
void release_drives(CanBus& bus, BusWait& wait, can::Watchdog watchdog = can::Watchdog::kRpdoTimer,
                    Nanoseconds patience = std::chrono::milliseconds(20));

/// Listens for another master before this one sends anything; a bus has one master. Two masters that start at the same
/// moment hear each other later, in transfer(). @return what was heard within `listening`, or nothing.
[[nodiscard]] std::optional<std::string> other_master(CanBus& bus, BusWait& wait,
                                                      Nanoseconds listening = std::chrono::milliseconds(60));

}  // namespace ligature::platform
