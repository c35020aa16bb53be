#include "sim_device/stats_file.hpp"

#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

namespace ligature::sim {
namespace {

namespace fs = std::filesystem;

/// The path with symbolic links resolved, even if the target does not exist yet.
fs::path without_links(fs::path path) {
  std::error_code none;
  for (int i = 0; i < 40 && fs::is_symlink(fs::symlink_status(path, none)); ++i)
    path = path.parent_path() / fs::read_symlink(path, none);
  return path;
}

double microseconds(Time t) { return std::chrono::duration<double, std::micro>(t).count(); }

}  // namespace

std::string stats_json(const std::string& hand, const HandDevice& device, const LoopStats& loop, long dropped_frames) {
  nlohmann::ordered_json j;
  std::int64_t trips = 0, syncs_without_rpdo = 0, replaced = 0;
  for (const auto& drive : device.drives()) {
    const DriveStats stats = drive->stats();
    trips += stats.watchdog_trips;
    syncs_without_rpdo += stats.syncs_without_rpdo;
    replaced += stats.late_rpdos;
  }
  j["hand"] = hand;
  j["syncs"] = device.bus_stats().syncs;
  j["missed_syncs"] = device.bus_stats().missed_syncs;
  j["bus_load"] = device.bus_load();  // fraction of time, 0 .. 1
  j["frames"] = device.wire_stats().frames;
  j["worst_bus_wait_us"] = microseconds(device.wire_stats().worst_wait);  // longest time from queueing to sending
  j["worst_rpdo_after_sync_us"] = microseconds(device.bus_stats().worst_rpdo);
  j["syncs_without_rpdo"] = syncs_without_rpdo;           // summed over drives, while enabled
  j["replaced_rpdos"] = replaced;                         // replaced by a second RPDO before the next SYNC
  j["watchdog_trips"] = trips;                            // times that a drive removed its torque by itself
  j["final_torque_permille"] = device.torque_permille();  // motor torques at the end, before power-off
  j["script_done"] = device.mechanics().is_done();
  j["wakeups"] = loop.wakeups;
  j["worst_wakeup_lateness_us"] = microseconds(loop.worst_lateness);
  j["stalls"] = loop.stalls;
  j["dropped_frames"] = dropped_frames;  // frames that a client did not read in time
  return j.dump(2) + "\n";
}

std::string objection_to(const std::string& path) {
  const fs::path target = without_links(path);
  std::error_code none;
  const auto found = fs::status(target, none);
  if (fs::exists(found) && !fs::is_regular_file(found)) return "is no regular file, allowed one or a new name";
  const fs::path folder = fs::absolute(target, none).parent_path();
  if (access(folder.c_str(), W_OK | X_OK) != 0) return "cannot be written, allowed a file in a folder that exists";
  return {};
}

bool write_file(const std::string& path, const std::string& text) {
  if (!objection_to(path).empty()) return false;  // the path may have changed since the check at the start
  const fs::path target = without_links(path);
  const std::string beside = target.string() + ".part-" + std::to_string(getpid());
  std::ofstream file(beside, std::ios::trunc);
  file << text;
  file.close();
  if (file.good() && std::rename(beside.c_str(), target.c_str()) == 0) return true;
  std::remove(beside.c_str());
  return false;
}

}  // namespace ligature::sim
