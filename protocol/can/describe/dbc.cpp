#include "protocol/can/describe/dbc.hpp"

#include "protocol/can/pdo_map.hpp"

namespace ligature::can {
namespace {

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
  return text + "CM_ \"Made by ligature-can-describe from protocol/can/pdo_map.hpp. Do not edit.\";\n";
}

}  // namespace ligature::can
