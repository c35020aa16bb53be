#include "protocol/can/describe/eds.hpp"

#include <cstdarg>
#include <cstdio>
#include <map>
#include <vector>

#include "protocol/can/object_table.hpp"

namespace ligature::can {
namespace {

/// Appends formatted text.
[[gnu::format(printf, 2, 3)]] void add(std::string& text, const char* format, ...) {
  char line[256];
  va_list arguments;
  va_start(arguments, format);
  std::vsnprintf(line, sizeof line, format, arguments);
  va_end(arguments);
  text += line;
}

std::string access_word(const ObjectRow& row) {
  switch (row.access) {
    case Access::kConst:
      return "const";
    case Access::kReadOnly:
      return "ro";
    case Access::kReadWrite:
      return "rw";
  }
  return "";
}

bool is_mappable(const ObjectRow& row) {
  for (const PdoField& f : kPdoFields) {
    if (f.object == row.object) return true;
  }
  return false;
}

std::string initial_value(const ObjectRow& row, NodeId node) {
  char text[32];
  const auto bits = static_cast<unsigned long long>(row.initial);
  if (row.adds_node_id) {
    std::snprintf(text, sizeof text, "$NODEID+0x%llX", bits - node.value);
  } else if (row.initial < 0) {
    std::snprintf(text, sizeof text, "%lld", static_cast<long long>(row.initial));
  } else {
    std::snprintf(text, sizeof text, "0x%llX", bits);
  }
  return text;
}

void add_variable(std::string& eds, const ObjectRow& row, NodeId node) {
  add(eds, "ParameterName=%.*s\nObjectType=0x7\nDataType=0x%04X\nAccessType=%s\n", static_cast<int>(row.name.size()),
      row.name.data(), static_cast<unsigned>(row.type), access_word(row).c_str());
  add(eds, "DefaultValue=%s\nPDOMapping=%d\n\n", initial_value(row, node).c_str(), is_mappable(row) ? 1 : 0);
}

void add_list(std::string& eds, const char* section, const std::vector<std::uint16_t>& indices) {
  add(eds, "[%s]\nSupportedObjects=%zu\n", section, indices.size());
  for (std::size_t i = 0; i < indices.size(); ++i) add(eds, "%zu=0x%04X\n", i + 1, indices[i]);
  eds += '\n';
}

void add_head(std::string& eds, NodeId node) {
  add(eds, "; Made by ligature-can-describe from protocol/can/pdo_map.hpp and object_table.hpp. Do not edit.\n");
  add(eds, "[FileInfo]\nFileName=ligature-node-%u.eds\nFileVersion=1\nFileRevision=0\nEDSVersion=4.0\n",
      unsigned{node.value});
  add(eds,
      "Description=CiA 402 joint drive of a haptic hand, cyclic synchronous "
      "torque\nCreatedBy=ligature-can-describe\n\n");
  add(eds, "[DeviceInfo]\nVendorName=Ligature\nVendorNumber=0\nProductName=Simulated joint drive %u\nProductNumber=0\n",
      unsigned{node.value});
  add(eds, "RevisionNumber=0\nOrderCode=0\n");
  for (const int kbit : {10, 20, 50, 125, 250, 500, 800, 1000})
    add(eds, "BaudRate_%d=%d\n", kbit, kbit == 1000 ? 1 : 0);
  add(eds, "SimpleBootUpMaster=0\nSimpleBootUpSlave=1\nGranularity=8\nDynamicChannelsSupported=0\nGroupMessaging=0\n");
  add(eds, "NrOfRXPDO=1\nNrOfTXPDO=1\nLSS_Supported=0\n\n");
}

}  // namespace

std::string eds_text(NodeId node) {
  const ObjectTable table = object_table(node);
  std::map<std::uint16_t, std::vector<ObjectRow>> by_index;
  for (const ObjectRow& row : table) by_index[row.object.index].push_back(row);

  std::string eds;
  add_head(eds, node);
  std::vector<std::uint16_t> mandatory, optional, manufacturer;
  for (const auto& [index, rows] : by_index) {
    const bool must = index == 0x1000 || index == 0x1001 || index == 0x1018;
    (must ? mandatory : index >= 0x2000 && index < 0x6000 ? manufacturer : optional).push_back(index);
  }
  add_list(eds, "MandatoryObjects", mandatory);
  add_list(eds, "OptionalObjects", optional);
  add_list(eds, "ManufacturerObjects", manufacturer);

  for (const auto& [index, rows] : by_index) {
    add(eds, "[%04X]\n", unsigned{index});
    if (rows.front().group.empty()) {
      add_variable(eds, rows.front(), node);
      continue;
    }
    const std::string_view group = rows.front().group;
    const unsigned type = index == 0x1016 ? 0x8 : 0x9;  // object type: array, or record
    add(eds, "ParameterName=%.*s\nObjectType=0x%X\nSubNumber=%zu\n\n", static_cast<int>(group.size()), group.data(),
        type, rows.size());
    for (const ObjectRow& row : rows) {
      add(eds, "[%04Xsub%X]\n", unsigned{index}, unsigned{row.object.sub});
      add_variable(eds, row, node);
    }
  }
  return eds;
}

}  // namespace ligature::can
