#include "protocol/scene/fault_script.hpp"

#include "protocol/scene/toml_text.hpp"

namespace ligature::scene {
namespace {

constexpr std::pair<const char*, FaultKind> kKinds[] = {
    {"lose", FaultKind::kLose},       {"delay", FaultKind::kDelay},         {"duplicate", FaultKind::kDuplicate},
    {"reorder", FaultKind::kReorder}, {"corrupt", FaultKind::kCorrupt},     {"freeze", FaultKind::kFreeze},
    {"jump", FaultKind::kJump},       {"reverse", FaultKind::kReverse},     {"button", FaultKind::kButton},
    {"reboot", FaultKind::kReboot},   {"emergency", FaultKind::kEmergency}, {"astray", FaultKind::kAstray},
    {"foreign", FaultKind::kForeign}};
constexpr std::pair<const char*, ForeignFrame> kFrames[] = {
    {"rpdo", ForeignFrame::kRpdo},           {"sync", ForeignFrame::kSync},
    {"heartbeat", ForeignFrame::kHeartbeat}, {"nmt-start", ForeignFrame::kNmtStart},
    {"nmt-stop", ForeignFrame::kNmtStop},    {"nmt-reset", ForeignFrame::kNmtReset},
    {"sdo-read", ForeignFrame::kSdoRead},    {"sdo-write", ForeignFrame::kSdoWrite}};
constexpr std::pair<const char*, int> kHands[] = {{"left", 0}, {"right", 1}};

void read_fault(StrictTable& t, FaultScript& s) {
  t.require("title");
  t.require("kind");
  t.require("hand");
  t.text("title", s.title);
  t.choice("kind", s.kind, kKinds);
  t.choice("hand", s.hand, kHands);
  t.integer("node", s.node, 0, 3);
  t.number("share", s.share, {0.0, 1.0});
  t.number("from_s", s.from_s, {0.0, 1e6});
  t.number("until_s", s.until_s, {0.0, 1e9});
  t.number("delay_s", s.delay_s, {0.0, 10.0});
  t.integer("counts", s.counts, -1000000, 1000000);
  t.integer("seed", s.seed, 0, 1000000);
  t.integer("permille", s.permille, -6000, 6000);
  t.choice("frame", s.frame, kFrames);
  t.number("period_s", s.period_s, {1e-4, 10.0});
}

void read_script(StrictTable& top, FaultScript& script) {
  top.require("fault");
  top.table("fault", [&](StrictTable& t) { read_fault(t, script); });
  top.table("expect", [&](StrictTable& t) {
    t.integer("fault", script.expected_fault, 0, 99);
    t.integer("within_ticks", script.within_ticks, 0, 1000);
  });
  top.finish();
}

}  // namespace

std::vector<KeyRow> fault_keys() {
  std::vector<KeyRow> rows;
  ReadContext context{{}, {}, {}, &rows};
  const toml::table root;
  FaultScript script;
  StrictTable top(root, "", context);
  read_script(top, script);
  return rows;
}

std::variant<FaultScript, Error> load_fault_script(const std::filesystem::path& path) {
  ReadContext context{path.string(), {}, {}};
  auto parsed = parse_toml_file(path);
  if (auto* error = std::get_if<Error>(&parsed)) return *error;
  const auto& root = std::get<toml::table>(parsed);
  FaultScript script;
  StrictTable top(root, "", context);
  read_script(top, script);
  if (context.error) return *context.error;
  return script;
}

}  // namespace ligature::scene
