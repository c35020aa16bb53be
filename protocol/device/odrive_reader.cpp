#include "protocol/device/odrive_reader.hpp"

#include "protocol/device/cia402_reader.hpp"

namespace ligature::device {
namespace {

constexpr std::pair<const char*, DriveWatchdog> kOdriveWatchdogs[] = {{"setpoints", DriveWatchdog::kRpdoTimer},
                                                                      {"none", DriveWatchdog::kNone}};
// Identifiers 0x001 .. 0x07F are those of the nodes 0 to 3: node << 5 | command. All drives obey those of node 0x3F.
constexpr int kFirstFree = 0x080, kLast = 0x7DF;

}  // namespace

void read_odrive(scene::StrictTable& t, OdriveProfile& p) {
  Source source = Source::kAssumed;
  t.require("source");
  t.require("torque_constant_Nm_per_A");
  t.choice("source", source, kSourceNames);
  t.choice("watchdog", p.watchdog, kOdriveWatchdogs);
  t.integer("watchdog_ms", p.watchdog_ms, 5, 10000);
  t.integer("heartbeat_ms", p.heartbeat_ms, 10, 50);  // three are faster than a drive starts anew
  t.number("torque_constant_Nm_per_A", p.torque_constant_Nm_per_A, {1e-6, 1e6});
  t.number("velocity_limit_rev_per_s", p.velocity_limit_rev_per_s, {1.0, 1000.0});
  int id = static_cast<int>(p.buttons_id);
  t.integer("buttons_id", id, kFirstFree, kLast);
  p.buttons_id = static_cast<std::uint32_t>(id);
}

}  // namespace ligature::device
