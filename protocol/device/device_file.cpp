#include "protocol/device/device_file.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "protocol/device/cia402_reader.hpp"
#include "protocol/device/device_keys.hpp"
#include "protocol/device/odrive_reader.hpp"
#include "protocol/device/omni_text.hpp"
#include "protocol/scene/toml_text.hpp"

namespace ligature::device {
namespace {

using scene::Error;
using scene::Range;
using scene::ReadContext;
using scene::StrictTable;

constexpr std::pair<const char*, Kinematics> kKinematics[] = {{"omni-serial", Kinematics::kOmniSerial},
                                                              {"cartesian", Kinematics::kCartesian}};
constexpr Range kPositive{1e-6, 1e6};
constexpr Range kNotNegative{0.0, 1e6};
constexpr double kFar = 100.0;  // m or rad: largest coordinate or angle

/// Reads entries {value = .., source = ".."} and stores their sources.
class Marked {
 public:
  Marked(StrictTable& table, std::string path, DeviceFile& out) : table_(table), path_(std::move(path)), out_(out) {}

  void number(const char* key, double& v, Range range) {
    entry(key, [&](StrictTable& t) { t.number("value", v, range); });
  }
  void integer(const char* key, int& v, int low, int high) {
    entry(key, [&](StrictTable& t) { t.integer("value", v, low, high); });
  }
  void optional_integer(const char* key, int& v, int low, int high) {
    table_.table(key,
                 [&](StrictTable& t) { value(t, key, [&](StrictTable& e) { e.integer("value", v, low, high); }); });
  }
  void vector(const char* key, Vec& v) {
    entry(key, [&](StrictTable& t) { t.vector("value", v, kFar); });
  }

 private:
  template <class Read>
  void entry(const char* key, Read read) {
    table_.require(key);
    table_.table(key, [&](StrictTable& t) { value(t, key, read); });
  }
  template <class Read>
  void value(StrictTable& t, const char* key, Read read) {
    t.require("value");
    t.require("source");
    read(t);
    Source source = Source::kAssumed;
    t.choice("source", source, kSourceNames);
    out_.sources.emplace_back(path_ + "." + key, source);
  }

  StrictTable& table_;
  std::string path_;
  DeviceFile& out_;
};

void read_identity(StrictTable& t, Device& d) {
  t.require("name");
  t.require("kinematics");
  t.text("name", d.name);
  t.choice("kinematics", d.kinematics, kKinematics);
}

void read_geometry(Marked t, Device& d) {
  t.vector("links_m", d.links_m);
  t.vector("home_tip_m", d.home_tip_m);
  t.vector("joint_min_rad", d.joint_min_rad);
  t.vector("joint_max_rad", d.joint_max_rad);
  t.vector("workspace_min_m", d.workspace_min_m);
  t.vector("workspace_max_m", d.workspace_max_m);
}

void read_drives(Marked t, Device& d) {
  t.integer("motor_counts", d.motor_counts, 1, 1 << 30);
  t.number("gear", d.gear, kPositive);
  t.number("rated_torque_Nm", d.rated_torque_Nm, kPositive);
  t.integer("max_torque_permille", d.max_torque_permille, 1, 32767);
  t.optional_integer("torque_tolerance_permille", d.torque_tolerance_permille, 1, 32767);
  t.number("delay_s", d.delay_s, {0.0, 1.0});
}

void read_feel(Marked t, Device& d) {
  t.number("apparent_mass_kg", d.apparent_mass_kg, kPositive);
  t.number("damping_N_s_per_m", d.damping_N_s_per_m, kNotNegative);
  t.number("coulomb_N", d.coulomb_N, kNotNegative);
}

void read_limits(Marked t, Device& d) {
  t.number("peak_force_N", d.peak_force_N, kPositive);
  t.number("continuous_force_N", d.continuous_force_N, kPositive);
  t.number("thermal_time_s", d.thermal_time_s, kPositive);
  t.number("velocity_limit_m_per_s", d.velocity_limit_m_per_s, kPositive);
  t.number("force_step_N", d.force_step_N, kPositive);
  t.number("force_slew_N_per_s", d.force_slew_N_per_s, kPositive);
  t.number("hand_acceleration_m_per_s2", d.hand_acceleration_m_per_s2, kPositive);
}

/// An ODrive or moteus tells its motor's angle, after power-on within one turn. So the motor must turn the joint
/// without a gear, and less than once over the whole range. The Omni's third drive sits in the base: its angle is the
/// sum of two. After power-on a moteus tells an angle of less than half a turn to either side.
void check_turns(StrictTable& geometry, const Device& d) {
  if (!d.odrive && !d.moteus) return;
  for (std::size_t i = 0; i < 3; ++i) {
    const bool is_sum = i == 2 && d.kinematics == Kinematics::kOmniSerial;
    const double low_rad = d.joint_min_rad[i] + (is_sum ? d.joint_min_rad[1] : 0.0);
    const double high_rad = d.joint_max_rad[i] + (is_sum ? d.joint_max_rad[1] : 0.0);
    if (high_rad - low_rad >= 2.0 * std::numbers::pi)
      geometry.refuse("joint_max_rad", "less than one turn of each motor: these drives cannot tell turns apart");
    else if (d.moteus && std::max(-low_rad, high_rad) >= std::numbers::pi)
      geometry.refuse("joint_max_rad", "with [moteus] less than half a turn of each motor to either side of 0");
  }
}

/// Checks relations between values.
void check(StrictTable& geometry, StrictTable& limits, const Device& d) {
  const int links = d.kinematics == Kinematics::kCartesian ? 3 : 2;
  for (std::size_t i = 0; i < 3; ++i) {
    if (static_cast<int>(i) < links && d.links_m[i] <= 0.0)
      geometry.refuse("links_m", "the first " + std::to_string(links) + " more than 0");
    if (d.joint_min_rad[i] >= d.joint_max_rad[i]) geometry.refuse("joint_max_rad", "more than joint_min_rad");
    if (d.workspace_min_m[i] >= d.workspace_max_m[i]) geometry.refuse("workspace_max_m", "more than workspace_min_m");
  }
  check_turns(geometry, d);
  if (d.continuous_force_N > d.peak_force_N) limits.refuse("continuous_force_N", "at most peak_force_N");
}

/// Whether the drive's object for the rated torque is fine enough for the comparison at start-up. All torques are per
/// mille of the rated torque, so a wrong value would falsify every force.
bool is_told_exactly(const Device& d) {
  constexpr double kShare = 0.005;
  if (!d.cia402.rated_torque.is_there()) return true;
  const double told = d.rated_torque_Nm / (d.cia402.at_motor ? d.gear : 1.0) / d.cia402.rated_torque_unit_Nm;
  return std::abs(std::round(told) - told) <= kShare * told;
}

void read_record(StrictTable& top, DeviceFile& out) {
  Device& d = out.device;
  top.table("device", [&](StrictTable& t) { read_identity(t, d); });
  top.table("drives", [&](StrictTable& t) {
    read_drives(Marked(t, "drives", out), d);
    top.table("cia402", [&](StrictTable& p) { read_cia402(p, d.cia402); });
    top.table("odrive", [&](StrictTable& p) {
      read_odrive(p, d.odrive.emplace());
      if (top.has("cia402")) p.refuse("source", "one of the tables [cia402] and [odrive]");
    });
    top.table("moteus", [&](StrictTable& p) {
      Source source = Source::kAssumed;
      p.require("source");
      p.choice("source", source, kSourceNames);
      d.moteus = true;
      t.require("torque_tolerance_permille");  // the torque is measured: the default is for torques told exactly
      if (top.has("cia402") || top.has("odrive"))
        p.refuse("source", "one of the tables [cia402], [odrive] and [moteus]");
    });
    if (!t.failed() && (d.odrive || d.moteus) && d.gear != 1.0)
      t.refuse("gear",
               "1 with [odrive] or [moteus]: with a gear the angle after power-on is ambiguous (docs/drives.md)");
    if (!t.failed() && d.motor_counts % d.cia402.counts_unit != 0)
      t.refuse("motor_counts", "a multiple of cia402.counts_unit");
    if (!t.failed() && !is_told_exactly(d)) t.refuse("rated_torque_Nm", "a multiple of cia402.rated_torque_unit_Nm");
  });
  top.table("feel", [&](StrictTable& t) { read_feel(Marked(t, "feel", out), d); });
  top.table("geometry", [&](StrictTable& g) {
    read_geometry(Marked(g, "geometry", out), d);
    top.table("limits", [&](StrictTable& l) {
      read_limits(Marked(l, "limits", out), d);
      if (!l.failed()) check(g, l, d);
    });
  });
  top.finish();
}

std::variant<DeviceFile, Error> read(const toml::table& root, const std::string& name) {
  for (const char* table : {"device", "geometry", "drives", "feel", "limits"}) {
    if (!root.contains(table)) return Error{name + ": no [" + table + "] table, allowed a device record with one"};
  }
  ReadContext context{name, {}, {}};
  DeviceFile out;
  StrictTable top(root, "", context);
  read_record(top, out);
  if (context.error) return *context.error;
  return out;
}

}  // namespace

std::vector<scene::KeyRow> device_keys() {
  std::vector<scene::KeyRow> rows;
  ReadContext context{{}, {}, {}, &rows};
  const toml::table root;
  DeviceFile out;
  StrictTable top(root, "", context);
  read_record(top, out);
  return rows;
}

std::variant<DeviceFile, Error> parse_device(const std::string& text, const std::string& name) {
  auto parsed = scene::parse_toml(text, name);
  if (auto* error = std::get_if<Error>(&parsed)) return *error;
  return read(std::get<toml::table>(parsed), name);
}

std::variant<DeviceFile, Error> load_device_file(const std::filesystem::path& path) {
  auto parsed = scene::parse_toml_file(path);
  if (auto* error = std::get_if<Error>(&parsed)) return *error;
  return read(std::get<toml::table>(parsed), path.string());
}

std::variant<Device, Error> load_device(const std::filesystem::path& path) {
  auto file = load_device_file(path);
  if (auto* error = std::get_if<Error>(&file)) return *error;
  return std::get<DeviceFile>(file).device;
}

const Device& omni() {
  static const Device device = [] {
    auto parsed = parse_device(kOmniText, "scenes/devices/omni.toml");
    // Impossible in practice: a test parses the same text
    if (auto* error = std::get_if<Error>(&parsed)) throw std::logic_error(error->text);
    return std::get<DeviceFile>(parsed).device;
  }();
  return device;
}

}  // namespace ligature::device
