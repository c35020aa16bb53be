// ligature-can-describe: exports the CAN protocol in formats of other tools. Prints to stdout only.
//   eds NODE | dbc | constants | encode | decode
// encode and decode process lines of stdin, one frame per line, so that a test can check thousands in one process:
//   encode  "tpdo1 NODE statusword position torque buttons" or "rpdo1 NODE controlword torque"  ->  "ID DATA" in hex
//   decode  "ID DATA" in hex  ->  the same words, or "none" if it is no mapped PDO

#include <charconv>
#include <cstdio>
#include <iostream>
#include <limits>
#include <sstream>
#include <string>
#include <string_view>

#include "protocol/can/bit_time.hpp"
#include "protocol/can/codec.hpp"
#include "protocol/can/describe/dbc.hpp"
#include "protocol/can/describe/eds.hpp"

namespace {

using namespace ligature::can;
constexpr int kBadInput = 2;

constexpr const char* kHelp =
    "ligature-can-describe: the rig's CAN layout in the languages other tools read\n"
    "  eds NODE    electronic data sheet of drive 1, 2 or 3\n"
    "  dbc         all process data of one hand's bus\n"
    "  constants   numbers of the codec, JSON\n"
    "  encode      stdin lines 'tpdo1 NODE statusword position torque buttons', 'rpdo1 NODE controlword torque' -> 'ID "
    "DATA'\n"
    "  decode      the reverse\n"
    "Example: ligature-can-describe dbc > hand.dbc && candump can0 | cantools decode hand.dbc\n"
    "Exit: 0 done, 2 bad usage or input, 3 standard output cannot be written.\n";

int refuse(const std::string& why) {
  std::cerr << "ligature-can-describe: " << why << '\n';
  return kBadInput;
}

bool is_joint(int node) { return node >= kWaist.value && node <= kElbow.value; }

std::string hex(const Frame& f) {
  char text[32];
  int n = std::snprintf(text, sizeof text, "%03X ", f.id);
  for (std::size_t i = 0; i < f.dlc; ++i)
    n += std::snprintf(text + n, sizeof text - static_cast<std::size_t>(n), "%02X", f.data[i]);
  return text;
}

/// Parses "ID DATA" in hex; false if the line has another form.
bool parse(const std::string& line, Frame& f) {
  std::istringstream in(line);
  std::string id, data;
  in >> id >> data;
  const auto read = [](std::string_view text, auto& value) {
    const auto r = std::from_chars(text.data(), text.data() + text.size(), value, 16);
    return r.ec == std::errc{} && r.ptr == text.data() + text.size();
  };
  if (!read(id, f.id) || f.id > kMaxId || data.size() % 2 != 0 || data.size() > 16) return false;
  f.dlc = static_cast<std::uint8_t>(data.size() / 2);
  for (std::size_t i = 0; i < f.dlc; ++i) {
    if (!read(std::string_view(data).substr(2 * i, 2), f.data[i])) return false;
  }
  return true;
}

constexpr const char* kForm = "allowed the form that --help shows";

/// Reads an integer into `out`. @return empty, or why the word is no valid integer.
template <class T>
std::string read_field(std::istringstream& in, const char* name, T& out) {
  std::string word;
  if (!(in >> word)) return std::string("found no ") + name + ", " + kForm;
  const auto r = std::from_chars(word.data(), word.data() + word.size(), out);
  if (r.ec == std::errc{} && r.ptr == word.data() + word.size()) return {};
  return std::string(name) + ": found '" + word.substr(0, 40) + "', allowed integer " +
         std::to_string(std::numeric_limits<T>::min()) + " .. " + std::to_string(std::numeric_limits<T>::max());
}

/// Handles one line. @return empty, or what is wrong with the line.
std::string encode_line(const std::string& line) {
  std::istringstream in(line);
  std::string kind, word, why;
  in >> kind;
  const bool is_rpdo = kind == "rpdo1";
  int node = 0;
  if (!is_rpdo && kind != "tpdo1") return "found '" + line.substr(0, 80) + "', " + kForm;
  if (why = read_field(in, "node", node); !why.empty()) return why;
  if (!is_joint(node)) return "node: found " + std::to_string(node) + ", allowed 1, 2 or 3";
  const NodeId id{static_cast<std::uint8_t>(node)};
  Rpdo1 rpdo;
  Tpdo1 tpdo;
  if (is_rpdo) {
    why = read_field(in, "controlword", rpdo.controlword);
    if (why.empty()) why = read_field(in, "torque", rpdo.target_torque_permille);
  } else {
    why = read_field(in, "statusword", tpdo.statusword);
    if (why.empty()) why = read_field(in, "position", tpdo.position_counts);
    if (why.empty()) why = read_field(in, "torque", tpdo.torque_permille);
    if (why.empty()) why = read_field(in, "buttons", tpdo.buttons);
  }
  if (!why.empty()) return why;
  if (in >> word) return "found '" + word.substr(0, 40) + "' after the last field, " + kForm;
  std::puts(hex(is_rpdo ? encode(id, rpdo) : encode(id, tpdo)).c_str());
  return {};
}

/// Error text if a PDO's frame is shorter than its fixed length, else empty.
std::string objection_to_length(const Frame& f) {
  const auto address = address_of(f.id);
  if (!address || !is_joint(address->node.value)) return {};
  const bool is_tpdo = address->service == Service::kTpdo1;
  const std::uint8_t length = is_tpdo ? 8 : 4;
  if ((!is_tpdo && address->service != Service::kRpdo1) || f.dlc >= length) return {};
  return "found " + std::to_string(f.dlc) + " bytes, allowed " + std::to_string(length);
}

std::string decode_line(const std::string& line) {
  Frame f;
  if (!parse(line, f)) return "found '" + line.substr(0, 80) + "', " + kForm;
  if (auto why = objection_to_length(f); !why.empty()) return why;
  for (const NodeId node : profile::kJointNodes) {
    if (const auto p = decode_tpdo1(node, f)) {
      std::printf("tpdo1 %d %u %d %d %u\n", node.value, unsigned{p->statusword}, p->position_counts,
                  int{p->torque_permille}, unsigned{p->buttons});
      return {};
    }
    if (const auto p = decode_rpdo1(node, f)) {
      std::printf("rpdo1 %d %u %d\n", node.value, unsigned{p->controlword}, int{p->target_torque_permille});
      return {};
    }
  }
  std::puts("none");
  return {};
}

int for_each_line(std::string (*work)(const std::string&)) {
  std::string line;
  for (long number = 1; std::getline(std::cin, line); ++number) {
    if (const auto why = work(line); !why.empty()) {
      std::fflush(stdout);
      return refuse("stdin:" + std::to_string(number) + ": " + why);
    }
  }
  return 0;
}

void print_constants() {
  std::printf(
      "{\"counts_per_revolution\": %d, \"rated_torque_mNm\": %u, \"max_torque_permille\": %d, \"bit_rate\": %u,\n",
      profile::kCountsPerRevolution, profile::kRatedTorque_mNm, profile::kMaxTorque_permille, profile::kBitRate);
  std::printf(" \"min_cycle_bits\": %u, \"max_cycle_bits\": %u, \"fields\": [", kMinCycleBits, kMaxCycleBits);
  const char* separator = "";
  for (const Pdo pdo : {Pdo::kTpdo1, Pdo::kRpdo1}) {
    for (const NodeId node : profile::kJointNodes) {
      for (const PdoField& f : layout_of(pdo, node)) {
        std::printf(
            "%s\n  {\"pdo\": \"%s\", \"node\": %d, \"index\": %u, \"sub\": %u, \"bits\": %u, \"offset_bits\": %u, "
            "\"signed\": %s, \"name\": \"%s\"}",
            separator, pdo == Pdo::kTpdo1 ? "tpdo1" : "rpdo1", node.value, unsigned{f.object.index},
            unsigned{f.object.sub}, unsigned{f.bits}, unsigned{f.offset_bits}, f.is_signed ? "true" : "false",
            std::string(f.name).c_str());
        separator = ",";
      }
    }
  }
  std::puts("]}");
}

int obey(int argc, char** argv) {
  const std::string command = argc > 1 ? argv[1] : "";
  if (command == "--help" || command == "-h") return std::fputs(kHelp, stdout) < 0;
  if (command == "--version") return std::puts("ligature-can-describe " LIGATURE_VERSION) < 0;
  if (command == "eds" && argc == 3) {
    const std::string node = argv[2];
    if (node.size() != 1 || !is_joint(node[0] - '0'))
      return refuse("eds: found node '" + node + "', allowed 1, 2 or 3");
    return std::fputs(eds_text(NodeId{static_cast<std::uint8_t>(node[0] - '0')}).c_str(), stdout) < 0;
  }
  if (argc != 2)
    return refuse("found " + std::to_string(argc - 1) +
                  " arguments, allowed: eds NODE, dbc, constants, encode, decode (see --help)");
  if (command == "dbc") return std::fputs(dbc_text().c_str(), stdout) < 0;
  if (command == "constants") return print_constants(), 0;
  if (command == "encode") return for_each_line(encode_line);
  if (command == "decode") return for_each_line(decode_line);
  return refuse("found '" + command + "', allowed: eds NODE, dbc, constants, encode, decode (see --help)");
}

}  // namespace

int main(int argc, char** argv) {
  const int code = obey(argc, argv);
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return code;
  std::cerr << "ligature-can-describe: standard output cannot be written\n";
  return 3;
}
