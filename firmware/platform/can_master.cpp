#include "firmware/platform/can_master.hpp"

#include <cstdio>
#include <utility>

#include "firmware/platform/foreign_frame.hpp"
#include "firmware/platform/hand_link.hpp"
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

/// Sets up one node.
class Setup {
 public:
  Setup(CanBus& bus, BusWait& wait, can::NodeId node, const can::StartupTimes& times, Nanoseconds patience,
        std::vector<std::string>* lacks)
      : bus_(bus), wait_(wait), node_(node), times_(times), patience_(patience), lacks_(lacks) {}

  std::optional<std::string> run() {
    const can::DriveFacts& drive = times_.drive;
    if (auto e = expect(drive.rated_torque_object, drive.rated_torque)) return e;
    if (auto e = expect(drive.counts_object, drive.counts)) return e;
    for (const can::SdoWrite& w : can::startup_plan(node_, times_)) {
      const can::Sdo* answer = nullptr;
      if (auto e = ask(w.object, can::sdo_write(node_, w.object, w.value, w.bytes), can::SdoKind::kWritten, answer))
        return e;
    }
    return expect_mode();
  }

 private:
  /// Checks that the drive reports the wanted mode of operation: in another mode it would take a torque for a speed or
  /// a position. Asks repeatedly, because a drive may need a moment to change its mode.
  std::optional<std::string> expect_mode() {
    constexpr auto kWanted = static_cast<std::uint8_t>(can::profile::kCyclicSynchronousTorque);
    const can::Object object = can::od::kModeOfOperationDisplay;
    for (const Nanoseconds deadline = wait_.now() + patience_;;) {
      const can::Sdo* answer = nullptr;
      if (auto e = ask(object, can::sdo_read(node_, object), can::SdoKind::kValue, answer)) return e;
      if (answer == nullptr || (answer->value & 0xFFU) == kWanted) return std::nullopt;
      if (wait_.now() >= deadline) return found(object, answer->value & 0xFFU, kWanted);
      if (auto other = other_master(bus_, wait_, std::chrono::milliseconds(5))) return other;
    }
  }

  [[nodiscard]] std::string found(const can::Object& object, std::uint32_t value, std::uint32_t wanted) const {
    return describe(node_, object, "found " + std::to_string(value) + ", allowed " + std::to_string(wanted));
  }

  /// Reads an object and checks that it has the value for which the unit conversions were computed.
  std::optional<std::string> expect(const can::Object& object, std::uint32_t wanted) {
    if (object.index == 0) return std::nullopt;  // the drive does not tell this
    const can::Sdo* answer = nullptr;
    if (auto e = ask(object, can::sdo_read(node_, object), can::SdoKind::kValue, answer)) return e;
    if (answer == nullptr || answer->value == wanted) return std::nullopt;
    return found(object, answer->value, wanted);
  }

  /// One SDO transfer: sends the request and checks the answer. @param answer  set by this function. Stays unset if the
  /// drive lacks an optional object: that is noted and is no error
  std::optional<std::string> ask(const can::Object& object, const can::Frame& request, can::SdoKind wanted,
                                 const can::Sdo*& answer) {
    auto [got, other] = transfer(bus_, wait_, request, patience_);
    if (other) return other;
    if (!got) return describe(node_, object, "no answer; remedy: check its power, node id, bit rate and cable");
    const bool missing = got->kind == can::SdoKind::kAbort &&
                         (got->value == can::sdo_abort::kNoSuchObject || got->value == can::sdo_abort::kNoSuchSubIndex);
    if (missing && times_.drive.may_lack(object)) {
      if (lacks_ != nullptr)
        lacks_->push_back(describe(node_, object, "missing in this drive, optional in its record"));
      return std::nullopt;
    }
    if (got->kind != wanted) return describe(node_, object, abort_text(got->value));
    answer_ = *got;
    answer = &answer_;
    return std::nullopt;
  }

  CanBus& bus_;
  BusWait& wait_;
  can::NodeId node_;
  const can::StartupTimes& times_;
  Nanoseconds patience_;
  std::vector<std::string>* lacks_;
  can::Sdo answer_;
};

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

/// Whether the drive says that its power stage is off.
bool says_off(CanBus& bus, BusWait& wait, can::NodeId node, Nanoseconds patience) {
  const auto answer = transfer(bus, wait, can::sdo_read(node, can::od::kStatusword), patience).sdo;
  if (!answer || answer->kind != can::SdoKind::kValue) return false;
  const auto state = can::cia402::state_of(static_cast<std::uint16_t>(answer->value));
  return state && is_off(*state);
}

}  // namespace

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
                                            std::vector<std::string>* lacks, Nanoseconds patience) {
  if (!bus.send(can::encode_nmt(can::NmtCommand::kEnterPreOperational))) return kTakesNoFrames;
  for (const can::NodeId node : can::profile::kJointNodes) {
    if (auto error = Setup(bus, wait, node, times, patience, lacks).run()) return error;
  }
  return std::nullopt;
}

bool start_drives(CanBus& bus) noexcept { return bus.send(can::encode_nmt(can::NmtCommand::kStart)); }

void release_drives(CanBus& bus, BusWait& wait, can::Watchdog watchdog, Nanoseconds patience) {
  bus.send(can::encode_nmt(can::NmtCommand::kEnterPreOperational));
  if (watchdog == can::Watchdog::kNone) return;
  for (const can::NodeId node : can::profile::kJointNodes) {
    // For a drive that does not obey, the watchdog is the last thing that removes its torque
    if (says_off(bus, wait, node, patience))
      (void)transfer(bus, wait, can::sdo_write(node, can::od::kConsumerHeartbeat, 0, 4), patience);
  }
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
