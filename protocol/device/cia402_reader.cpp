#include "protocol/device/cia402_reader.hpp"

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>

namespace ligature::device {
namespace {

using scene::StrictTable;

constexpr std::pair<const char*, DriveWatchdog> kWatchdogs[] = {{"rpdo-timer", DriveWatchdog::kRpdoTimer},
                                                                {"heartbeat", DriveWatchdog::kHeartbeat},
                                                                {"none", DriveWatchdog::kNone}};
constexpr std::pair<const char*, ButtonsWord> kButtons[] = {{"ligature", ButtonsWord::kLigature},
                                                            {"inputs", ButtonsWord::kInputs}};
constexpr std::pair<const char*, bool> kShafts[] = {{"joint", false}, {"motor", true}};
constexpr std::size_t kMostWords = 16;  // entries of a list; start-up stores as many

/// A hexadecimal number of at most `most` digits, without a sign.
std::optional<unsigned> hexadecimal(std::string_view digits, std::size_t most) {
  unsigned number = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number, 16);
  if (error != std::errc{} || end != digits.data() + digits.size() || digits.size() > most) return std::nullopt;
  return number;
}

std::optional<ObjectAddress> object_of(std::string_view word) {
  const auto colon = word.find(':');
  if (!word.starts_with("0x") || colon == std::string_view::npos) return std::nullopt;
  const auto index = hexadecimal(word.substr(2, colon - 2), 4), sub = hexadecimal(word.substr(colon + 1), 2);
  if (!index || *index == 0 || !sub) return std::nullopt;
  return ObjectAddress{static_cast<std::uint16_t>(*index), static_cast<std::uint8_t>(*sub)};
}

/// "0x1800:03=0/2": object, value, number of bytes.
std::optional<ObjectWrite> write_of(const std::string& word) {
  const auto equals = word.find('=');
  const auto object = object_of(word.substr(0, equals));
  if (!object || equals == std::string::npos) return std::nullopt;
  const char* const begin = word.c_str() + equals + 1;
  char* end = nullptr;
  const long long value = std::strtoll(begin, &end, 0);  // base 0: decimal, or hexadecimal after 0x
  if (end == begin || *end != '/') return std::nullopt;
  const std::string_view width = end + 1;
  if (width != "1" && width != "2" && width != "4") return std::nullopt;
  const int bytes = width[0] - '0';
  const long long most = (1LL << (8 * bytes)) - 1;
  if (value > most || value < -(most + 1) / 2) return std::nullopt;
  return ObjectWrite{*object, static_cast<std::uint32_t>(value & most), bytes};
}

std::string text_of(const ObjectAddress& object) {
  if (!object.is_there()) return "none";
  char text[16];
  std::snprintf(text, sizeof text, "0x%04X:%02X", object.index, object.sub);
  return text;
}

void read_object(StrictTable& t, const char* key, ObjectAddress& out, bool may_lack) {
  std::string text = text_of(out);
  t.text(key, text);
  if (may_lack && text == "none") return void(out = {});
  const auto object = object_of(text);
  if (!object)
    return t.refuse(key, may_lack ? "an object as \"0x6076:00\", or \"none\"" : "an object as \"0x6076:00\"");
  out = *object;
}

/// Reads a text of words that are separated by spaces.
template <class Item, class Parse>
void read_list(StrictTable& t, const char* key, std::vector<Item>& out, Parse parse, const char* allowed) {
  std::string text, word;
  t.text(key, text);
  std::istringstream words(text);
  while (words >> word) {
    const auto item = parse(word);
    if (!item || out.size() == kMostWords) return t.refuse(key, allowed);
    out.push_back(*item);
  }
}

void read_buttons(StrictTable& t, ButtonsPlace& b) {
  t.choice("buttons", b.word, kButtons);
  t.integer("buttons_node", b.node, 1, 3);
  read_object(t, "buttons_object", b.object, false);
  t.integer("buttons_bits", b.bits, 8, 32);
  t.integer("dead_man_bit", b.dead_man_bit, 0, 31);
  t.integer("grip_bit", b.grip_bit, -1, 31);
  t.integer("clutch_bit", b.clutch_bit, -1, 31);
}

/// Checks the rules between several keys. If a default value breaks a rule, the message names a key that is in the file
/// instead.
void check_buttons(StrictTable& t, const ButtonsPlace& b, int pdos) {
  if (b.bits % 8 != 0 || b.bits == 24) t.refuse("buttons_bits", "8, 16 or 32");
  if (!b.are_inputs() && (b.bits != 16 || b.grip_bit != 0 || b.dead_man_bit != 1 || b.clutch_bit != 2))
    t.refuse(t.has("buttons") ? "buttons" : "source",
             "with buttons = \"inputs\"; \"ligature\" only with the 16 bits of docs/wire.md");
  if (b.are_inputs() && (!t.has("buttons_object") || !t.has("dead_man_bit")))
    t.refuse("buttons", "\"inputs\" only with buttons_object and dead_man_bit");
  if (b.are_inputs() && pdos < 2)
    t.refuse("buttons", "\"inputs\" only with pdos of 2 or more: they need a TPDO of their own");
  if (b.dead_man_bit >= b.bits) t.refuse("dead_man_bit", "less than buttons_bits");
  for (const auto& [key, bit] : {std::pair{"grip_bit", b.grip_bit}, std::pair{"clutch_bit", b.clutch_bit}}) {
    if (bit >= b.bits) t.refuse(key, "less than buttons_bits");
    if (bit == b.dead_man_bit)
      t.refuse(t.has(key) ? key : "dead_man_bit", "another bit than that of the grip and the clutch");
  }
}

void check_optional(StrictTable& t, const Cia402Profile& p) {
  for (const ObjectAddress& o : p.optional) {
    const bool watches = (o == ObjectAddress{0x1400, 5} && p.watchdog == DriveWatchdog::kRpdoTimer) ||
                         (o == ObjectAddress{0x1016, 1} && p.watchdog != DriveWatchdog::kNone);
    if (watches) t.refuse("optional", "no object of the watchdog; remedy: another value of watchdog");
    if (o == ObjectAddress{0x6007, 0} && p.watchdog != DriveWatchdog::kNone)
      t.refuse("optional", "not 0x6007:00, by which the watchdog and NMT stop end the torque; or watchdog = \"none\"");
    if (o == ObjectAddress{0x6060, 0}) t.refuse("optional", "not the mode 0x6060:00");
    if (o.index >= 0x1400 && o.index < 0x1C00) t.refuse("optional", "no PDO parameters");
    if (o == p.buttons.object) t.refuse("optional", "not the buttons: without them there is no dead-man");
  }
}

/// What commands a drive is for the loop alone: written at start-up, it could move a hand before anything was checked.
void check_writes(StrictTable& t, const Cia402Profile& p) {
  constexpr std::array<std::uint16_t, 10> kCommands{0x6040, 0x6042, 0x6060, 0x6071, 0x607A,
                                                    0x60B0, 0x60B1, 0x60B2, 0x60FE, 0x60FF};
  for (const auto& write : p.writes)
    if (std::ranges::find(kCommands, write.object.index) != kCommands.end())
      t.refuse("writes", "no controlword, mode, set point, offset or output (" + text_of(write.object) + ")");
}

}  // namespace

void read_cia402(StrictTable& t, Cia402Profile& p) {
  Source source = Source::kAssumed;
  t.require("source");
  t.choice("source", source, kSourceNames);
  read_object(t, "counts_object", p.counts, true);
  t.integer("counts_unit", p.counts_unit, 1, 1 << 20);
  read_object(t, "rated_torque_object", p.rated_torque, true);
  t.number("rated_torque_unit_Nm", p.rated_torque_unit_Nm, {1e-9, 1.0});
  t.choice("objects_at", p.at_motor, kShafts);
  read_object(t, "max_torque_object", p.max_torque, true);
  t.integer("pdos", p.pdos, 1, 4);
  read_buttons(t, p.buttons);
  t.choice("watchdog", p.watchdog, kWatchdogs);
  t.integer("watchdog_ms", p.watchdog_ms, 1, 10000);
  read_list(t, "optional", p.optional, object_of, "up to 16 objects as \"0x6007:00 0x6072:00\"");
  read_list(t, "writes", p.writes, write_of, "up to 16 of \"0x1800:03=0/2\": object=value/bytes, 1, 2 or 4 bytes");
  if (t.failed()) return;
  check_buttons(t, p.buttons, p.pdos);
  check_optional(t, p);
  check_writes(t, p);
}

}  // namespace ligature::device
