#include "firmware/platform/can_master.hpp"

#include <cmath>
#include <cstdio>
#include <utility>

#include "firmware/platform/foreign_frame.hpp"
#include "protocol/can/device_profile.hpp"
#include "protocol/can/nmt.hpp"

namespace ligature::platform {
namespace {

std::string describe(can::NodeId node, const can::Object& object, const std::string& what) {
  char at[48];
  std::snprintf(at, sizeof at, "node %d, object 0x%04X:%02X: ", static_cast<int>(node.value), object.index, object.sub);
  return at + what;
}

std::string abort_text(std::uint32_t code) {
  char text[48];
  std::snprintf(text, sizeof text, "refused by the drive, abort code 0x%08X", code);
  return text;
}

/// Reads an object and checks that it has the value for which the unit conversions were computed.
std::optional<std::string> expect(CanBus& bus, BusWait& wait, can::NodeId node, const can::Object& object,
                                  std::uint32_t wanted, Nanoseconds patience) {
  const auto [answer, other] = transfer(bus, wait, can::sdo_read(node, object), patience);
  if (other) return other;
  if (!answer) return describe(node, object, "no answer");
  if (answer->kind != can::SdoKind::kValue) return describe(node, object, abort_text(answer->value));
  if (answer->value == wanted) return std::nullopt;
  return describe(node, object, "found " + std::to_string(answer->value) + ", allowed " + std::to_string(wanted));
}

std::optional<std::string> configure(CanBus& bus, BusWait& wait, can::NodeId node, const can::StartupTimes& times,
                                     Nanoseconds patience) {
  if (auto e = expect(bus, wait, node, can::od::kRatedTorque, times.drive.rated_torque_mNm, patience)) return e;
  if (auto e = expect(bus, wait, node, can::od::kEncoderIncrements, times.drive.counts_per_revolution, patience))
    return e;
  for (const can::SdoWrite& w : can::startup_plan(node, times)) {
    const auto [answer, other] = transfer(bus, wait, can::sdo_write(node, w.object, w.value, w.bytes), patience);
    if (other) return other;
    if (!answer) return describe(node, w.object, "no answer");
    if (answer->kind != can::SdoKind::kWritten) return describe(node, w.object, abort_text(answer->value));
  }
  return std::nullopt;
}

/// Error text for a frame that only a controller sends; nothing for a drive's frame.
std::optional<std::string> told_of_other(const can::Frame& frame) {
  const rt::Foreign kind = foreign_kind(frame);
  if (kind == rt::Foreign::kNone) return std::nullopt;
  char text[160];
  std::snprintf(text, sizeof text,
                "another controller is on this bus: it sends %s (0x%03X); remedy: end or unplug it, a bus has one",
                name(kind), frame.id);
  return text;
}

}  // namespace

can::DriveFacts drive_facts(const device::Device& d) noexcept {
  return {static_cast<std::uint32_t>(std::lround(1e3 * d.rated_torque_Nm)),
          static_cast<std::uint32_t>(std::lround(d.counts_per_revolution())),
          static_cast<std::uint16_t>(d.max_torque_permille)};
}

SdoAnswer transfer(CanBus& bus, BusWait& wait, const can::Frame& request, Nanoseconds patience) {
  const auto asked = can::decode_sdo(request);
  const Nanoseconds deadline = wait.now() + patience;
  if (!asked || !bus.send(request)) return {};
  do {
    can::Frame frame;
    Receive got;
    while ((got = bus.receive(frame)) == Receive::kFrame) {
      if (auto other = told_of_other(frame)) return {std::nullopt, std::move(other)};
      const auto address = can::address_of(frame.id);
      if (!address || address->service != can::Service::kSdoResponse) continue;
      const auto answer = can::decode_sdo(frame);
      if (answer && answer->node == asked->node && answer->object == asked->object) return {answer, std::nullopt};
    }
    if (got == Receive::kLost) return {};
  } while (wait.wait(deadline));
  return {};
}

std::optional<std::string> configure_drives(CanBus& bus, BusWait& wait, const can::StartupTimes& times,
                                            Nanoseconds patience) {
  if (!bus.send(can::encode_nmt(can::NmtCommand::kEnterPreOperational))) return "the bus takes no frames";
  for (const can::NodeId node : can::profile::kJointNodes) {
    if (auto error = configure(bus, wait, node, times, patience)) return error;
  }
  return std::nullopt;
}

bool start_drives(CanBus& bus) noexcept { return bus.send(can::encode_nmt(can::NmtCommand::kStart)); }

void release_drives(CanBus& bus, BusWait& wait, Nanoseconds patience) {
  bus.send(can::encode_nmt(can::NmtCommand::kEnterPreOperational));
  for (const can::NodeId node : can::profile::kJointNodes)
    (void)transfer(bus, wait, can::sdo_write(node, can::od::kConsumerHeartbeat, 0, 4), patience);
}

std::optional<std::string> other_master(CanBus& bus, BusWait& wait, Nanoseconds listening) {
  const Nanoseconds deadline = wait.now() + listening;
  do {
    can::Frame frame;
    Receive got;
    while ((got = bus.receive(frame)) == Receive::kFrame) {
      if (auto other = told_of_other(frame)) return other;
    }
    if (got == Receive::kLost) return std::nullopt;  // reported by the next user of the bus
  } while (wait.wait(deadline));
  return std::nullopt;
}

}  // namespace ligature::platform
