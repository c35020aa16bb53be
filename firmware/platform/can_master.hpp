#pragma once
// Bringing the three drives of a hand from power-on to cyclic operation; before the loop, may take its time.

#include <chrono>
#include <optional>
#include <string>

#include "firmware/platform/bus_wait.hpp"
#include "firmware/platform/can_bus.hpp"
#include "protocol/can/sdo.hpp"
#include "protocol/can/startup.hpp"
#include "protocol/device/device.hpp"

namespace ligature::platform {

/// What start-up expects of the drives of a device and sets in them.
[[nodiscard]] can::DriveFacts drive_facts(const device::Device& device) noexcept;

/// One expedited transfer: request out, matching answer in; other drives' frames are skipped.
struct SdoAnswer {
  std::optional<can::Sdo> sdo;  ///< nothing: no answer in time, somebody else commands, or the bus is gone
  std::optional<std::string> other_master{};  ///< what was heard of one meanwhile
};
[[nodiscard]] SdoAnswer transfer(CanBus& bus, BusWait& wait, const can::Frame& request, Nanoseconds patience);

/// Puts the nodes into pre-operational, checks that rated torque and encoder are the ones the units are computed
/// with, and writes startup_plan() (mapping, watchdogs, torque limit, cyclic synchronous torque mode).
/// @return why it failed, one line, or nothing. The bus is left in pre-operational: no torque is possible.
[[nodiscard]] std::optional<std::string> configure_drives(CanBus& bus, BusWait& wait, const can::StartupTimes& times,
                                                          Nanoseconds patience = std::chrono::milliseconds(500));

/// NMT start: from now on the drives answer SYNC with TPDOs. They stay switched off until asked.
bool start_drives(CanBus& bus) noexcept;

/// The end of a run: NMT pre-operational, where drives are disabled and need no RPDOs, then every drive's watch over
/// our heartbeat off, so that our silence is no fault to them. What a drive does not answer is left as it is.
void release_drives(CanBus& bus, BusWait& wait, Nanoseconds patience = std::chrono::milliseconds(20));

/// Listens before we speak: a bus has one master. Two that began to listen in the same moment hear each other in
/// transfer(). @return what another one sent within `listening`, or nothing.
[[nodiscard]] std::optional<std::string> other_master(CanBus& bus, BusWait& wait,
                                                      Nanoseconds listening = std::chrono::milliseconds(60));

}  // namespace ligature::platform
