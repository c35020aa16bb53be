#include "protocol/device/odrive_reader.hpp"

#include "protocol/device/cia402_reader.hpp"

namespace ligature::device {
namespace {

constexpr std::pair<const char*, DriveWatchdog> kWatchdogs[] = {{"setpoints", DriveWatchdog::kRpdoTimer},
                                                                {"none", DriveWatchdog::kNone}};
// Identifiers 0x001 .. 0x07F are those of the nodes 0 to 3: node << 5 | command
constexpr int kFirstFree = 0x080, kLast = 0x7FF;

}  // namespace

void read_odrive(scene::StrictTable& t, OdriveProfile& p) {
  Source source = Source::kAssumed;
  t.require("source");
  t.choice("source", source, kSourceNames);
  t.choice("watchdog", p.watchdog, kWatchdogs);
  t.integer("watchdog_ms", p.watchdog_ms, 5, 10000);
  t.integer("heartbeat_ms", p.heartbeat_ms, 10, 1000);
  int id = static_cast<int>(p.buttons_id);
  t.integer("buttons_id", id, kFirstFree, kLast);
  p.buttons_id = static_cast<std::uint32_t>(id);
}

}  // namespace ligature::device
