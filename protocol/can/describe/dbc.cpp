#include "protocol/can/describe/dbc.hpp"

#include "protocol/can/pdo_map.hpp"

namespace ligature::can {
namespace {

/// DBC signal that is unsigned, little endian and without unit.
std::string plain_signal(const char* name, int first_bit, int bits) {
  return " SG_ " + std::string(name) + " : " + std::to_string(first_bit) + "|" + std::to_string(bits) +
         "@1+ (1,0) [0|0] \"\" Vector__XXX\n";
}

std::string head(std::uint32_t id, const std::string& name, int bytes, const std::string& sender) {
  return "BO_ " + std::to_string(id) + " " + name + ": " + std::to_string(bytes) + " " + sender + "\n";
}

/// Messages of the CiA 301 services EMCY, SDO and heartbeat of one node.
std::string services_of(NodeId node) {
  const std::string drive = node_name(node.value);
  const auto id = [node](Service s) { return cob_id(s, node).value; };
  const std::string transfer = plain_signal("Specifier", 0, 8) + plain_signal("Index", 8, 16) +
                               plain_signal("Subindex", 24, 8) + plain_signal("Value", 32, 32) + "\n";
  return head(id(Service::kEmcy), drive + "_Emergency", 8, drive) + plain_signal("ErrorCode", 0, 16) +
         plain_signal("ErrorRegister", 16, 8) + plain_signal("MakersOwn", 24, 40) + "\n" +
         head(id(Service::kSdoResponse), drive + "_SdoResponse", 8, drive) + transfer +
         head(id(Service::kSdoRequest), drive + "_SdoRequest", 8, "Controller") + transfer +
         head(id(Service::kHeartbeat), drive + "_Heartbeat", 1, drive) + plain_signal("NmtState", 0, 8) + "\n";
}

std::string services_of_controller() {
  return head(kNmtCobId.value, "Nmt", 2, "Controller") + plain_signal("Command", 0, 8) + plain_signal("Node", 8, 8) +
         "\n" + head(cob_id(Service::kHeartbeat, kMasterNode).value, "Controller_Heartbeat", 1, "Controller") +
         plain_signal("NmtState", 0, 8) + "\n";
}

std::string message(Pdo pdo, NodeId node) {
  const bool rpdo = pdo == Pdo::kRpdo1;
  const std::uint32_t id = cob_id(rpdo ? Service::kRpdo1 : Service::kTpdo1, node).value;
  const std::string drive = node_name(node.value);
  const std::string sender = rpdo ? "Controller" : drive, receiver = rpdo ? drive : "Controller";
  std::string text = "BO_ " + std::to_string(id) + " " + drive + (rpdo ? "_RPDO1: " : "_TPDO1: ") +
                     std::to_string(length_bytes(pdo, node)) + " " + sender + "\n";
  for (const PdoField& f : layout_of(pdo, node)) {
    text += " SG_ " + std::string(f.name) + " : " + std::to_string(f.offset_bits) + "|" + std::to_string(f.bits) +
            "@1" + (f.is_signed ? "-" : "+") + " (1,0) [0|0] \"" + std::string(f.unit) + "\" " + receiver + "\n";
  }
  return text + "\n";
}

}  // namespace

const char* node_name(unsigned node_id) noexcept {
  switch (node_id) {
    case kWaist.value:
      return "Waist";
    case kShoulder.value:
      return "Shoulder";
    case kElbow.value:
      return "Elbow";
    default:
      return "Node";
  }
}

std::string dbc_text() {
  std::string text = "VERSION \"1\"\n\nNS_ :\n\nBS_:\n\nBU_: Controller";
  for (const NodeId node : profile::kJointNodes) text += std::string(" ") + node_name(node.value);
  text += "\n\nBO_ " + std::to_string(kSyncCobId.value) + " Sync: 0 Controller\n\n";
  for (const Pdo pdo : {Pdo::kTpdo1, Pdo::kRpdo1}) {
    for (const NodeId node : profile::kJointNodes) text += message(pdo, node);
  }
  text += services_of_controller();
  for (const NodeId node : profile::kJointNodes) text += services_of(node);
  return text + "CM_ \"Made by ligature-can-describe from protocol/can/pdo_map.hpp. Do not edit.\";\n";
}

}  // namespace ligature::can
