#include "sim_device/profile_node.hpp"

#include <cmath>

#include "protocol/can/nmt.hpp"
#include "protocol/can/pdo_map.hpp"

namespace ligature::sim {
namespace {

namespace od = can::od;
constexpr std::uint8_t kThirdOfSample = 3;   // sub-index in the mapping of TPDO 1

constexpr can::Object of(device::ObjectAddress o) noexcept { return {o.index, o.sub}; }

}  // namespace

ProfileNode::ProfileNode(can::NodeId id, const device::Device& device, const DriveConstants& constants)
    : DriveNode(id, constants), profile_(device.cia402) {
  const double gear = profile_.at_motor ? device.gear : 1.0;
  counts_ = static_cast<std::uint32_t>(std::lround(constants.counts_per_revolution / gear / profile_.counts_unit));
  rated_torque_ =
      static_cast<std::uint32_t>(std::lround(constants.rated_torque_mNm * 1e-3 / gear / profile_.rated_torque_unit_Nm));
  add_entries();
}

void ProfileNode::power_on(Time now, std::vector<can::Frame>& out) {
  add_entries();
  DriveNode::power_on(now, out);
}

void ProfileNode::add_entries() {
  entries_.clear();
  for (const auto& w : profile_.writes)
    entries_[{w.object.index, w.object.sub}] = {0, static_cast<std::uint8_t>(w.bytes)};
  for (int n = 2; n <= profile_.pdos; ++n) {
    add_pdo(false, static_cast<unsigned>(n));
    add_pdo(true, static_cast<unsigned>(n));
  }
  if (profile_.counts.is_there()) entries_[{profile_.counts.index, profile_.counts.sub}] = {counts_, 4, true};
  if (profile_.rated_torque.is_there())
    entries_[{profile_.rated_torque.index, profile_.rated_torque.sub}] = {rated_torque_, 4, true};
}

/// A PDO that is on and sends or takes nothing, until it is mapped.
void ProfileNode::add_pdo(bool rpdo, unsigned number) {
  const can::PdoPlace pdo = can::pdo_place(rpdo, number, id());
  entries_[{pdo.communication.index, 1}] = {pdo.id, 4};
  entries_[{pdo.communication.index, 2}] = {0, 1};
  entries_[{pdo.map.index, 0}] = {0, 1};
  entries_[{pdo.map.index, 1}] = {0, 4};
}

/// Whether an object of our own drive is not in the record's.
bool ProfileNode::is_missing(can::Object object) const noexcept {
  using device::DriveWatchdog;
  if (object == od::kRpdo1EventTimer) return profile_.watchdog != DriveWatchdog::kRpdoTimer;
  if (object == od::kConsumerHeartbeat) return profile_.watchdog == DriveWatchdog::kNone;
  if (object.index == od::kEncoderIncrements.index) return object != of(profile_.counts);
  if (object == od::kRatedTorque) return object != of(profile_.rated_torque);
  if (object == od::kMaxTorque) return object != of(profile_.max_torque);
  return object.index == od::kStylusButtons.index && profile_.buttons.are_inputs();
}

void ProfileNode::on_frame(const can::Frame& frame, Time now, const Sensed& sensed, std::vector<can::Frame>& out) {
  if (const auto m = can::decode_nmt(frame); m && m->is_for(id()) && m->command == can::NmtCommand::kResetCommunication)
    add_entries();
  const auto request = can::decode_sdo(frame);
  const bool is_asked = request && request->node == id() &&
                        (request->kind == can::SdoKind::kRead || request->kind == can::SdoKind::kWrite);
  if (!is_asked || nmt_state() == can::NmtState::kStopped) return DriveNode::on_frame(frame, now, sensed, out);
  if (const auto told = answer(*request)) return out.push_back(can::encode(*told));
  can::Sdo own = *request;
  const can::PdoPlace sample = can::pdo_place(false, 1, id());
  if (own.object == can::Object{sample.map.index, kThirdOfSample} && own.value == third_word())
    own.value = can::mapping_word(can::layout_of(can::Pdo::kTpdo1, id()).fields[kThirdOfSample - 1]);
  DriveNode::on_frame(can::encode(own), now, sensed, out);
}

/// The answer for an object that our own drive lacks, or that this drive lacks; nothing for all others.
std::optional<can::Sdo> ProfileNode::answer(const can::Sdo& request) {
  using can::Sdo;
  using can::SdoKind;
  const auto abort = [&](std::uint32_t code) { return Sdo{SdoKind::kAbort, id(), request.object, code, 0}; };
  const auto found = entries_.find({request.object.index, request.object.sub});
  if (found == entries_.end()) {
    if (is_missing(request.object)) return abort(can::sdo_abort::kNoSuchObject);
    return std::nullopt;
  }
  Entry& entry = found->second;
  if (request.kind == SdoKind::kRead) return Sdo{SdoKind::kValue, id(), request.object, entry.value, entry.bytes};
  if (const std::uint32_t code = refusal(request, entry); code != 0) return abort(code);
  entry.value = request.value;
  return Sdo{SdoKind::kWritten, id(), request.object, 0, 0};
}

/// Why an object may not be written; 0: it may. A PDO is mapped while it is off, and TPDO 2 to the buttons only.
std::uint32_t ProfileNode::refusal(const can::Sdo& request, const Entry& entry) const {
  if (entry.is_constant) return can::sdo_abort::kReadOnly;
  if (request.bytes != entry.bytes) return can::sdo_abort::kWrongLength;
  const auto [index, sub] = request.object;
  const bool is_map = (index > 0x1600 && index < 0x1604) || (index > 0x1A00 && index < 0x1A04);
  if (!is_map) return 0;
  const auto communication = entries_.find({static_cast<std::uint16_t>(index - 0x200), std::uint8_t{1}});
  if (communication == entries_.end() || (communication->second.value & can::kPdoOff) == 0)
    return can::sdo_abort::kWrongDeviceState;
  const bool is_inputs = has_buttons() && profile_.buttons.are_inputs() && index == 0x1A01;
  if (sub != 0 && !(is_inputs && request.value == inputs_word())) return can::sdo_abort::kCannotBeMapped;
  return 0;
}

/// Third object of TPDO 1: the torque, or our own buttons' word.
std::uint32_t ProfileNode::third_word() const noexcept {
  if (has_buttons() && !profile_.buttons.are_inputs()) return inputs_word();
  return can::mapping_word(can::field_of(can::Pdo::kTpdo1, od::kTorqueActual));
}

std::uint32_t ProfileNode::inputs_word() const noexcept {
  return can::mapping_word(
      can::ButtonsSource{id(), of(profile_.buttons.object), static_cast<std::uint8_t>(profile_.buttons.bits), false});
}

/// Whether TPDO 2 is on, synchronous, and has one object.
bool ProfileNode::sends_inputs() const {
  if (!has_buttons() || !profile_.buttons.are_inputs()) return false;
  const auto value = [this](std::uint16_t index, std::uint8_t sub) { return entries_.at({index, sub}).value; };
  return (value(0x1801, 1) & can::kPdoOff) == 0 && value(0x1801, 2) == can::profile::kSynchronousEverySync &&
         value(0x1A01, 0) == 1 && value(0x1A01, 1) == inputs_word();
}

void ProfileNode::send_sample(const can::Tpdo1& sample, const Sensed& sensed, std::vector<can::Frame>& out) {
  const bool has_word = has_buttons() && !profile_.buttons.are_inputs();
  can::Frame frame = can::encode(has_word ? can::kElbow : can::kWaist, sample);  // the layouts of our own drives
  frame.id = can::cob_id(can::Service::kTpdo1, id()).value;
  out.push_back(frame);
  if (!sends_inputs()) return;
  std::uint32_t word = 0;
  const auto& b = profile_.buttons;
  for (const auto& [pressed, bit] :
       {std::pair{can::profile::kButtonGrip, b.grip_bit}, std::pair{can::profile::kButtonDeadMan, b.dead_man_bit},
        std::pair{can::profile::kButtonClutch, b.clutch_bit}}) {
    if (bit >= 0 && (sensed.buttons & pressed) != 0) word |= 1U << static_cast<unsigned>(bit);
  }
  can::Frame inputs{can::pdo_place(false, 2, id()).id, static_cast<std::uint8_t>(b.bits / 8), {}};
  can::set_data_word(inputs, word);
  out.push_back(inputs);
}

}  // namespace ligature::sim
