#include "host/csv_tables.hpp"

#include "host/export.hpp"
#include "host/export_csv.hpp"
#include "host/names.hpp"
#include "host/tick_columns.hpp"
#include "host/tick_statistics.hpp"

namespace ligature::host {
namespace {

/// Column names of a vector: ",left_f_x_N,left_f_y_N,left_f_z_N" for ("left", "f", "_N").
std::string xyz(std::string_view hand, std::string_view quantity, std::string_view unit) {
  std::string names;
  for (const char axis : {'x', 'y', 'z'}) {
    names += ',';
    names.append(hand).append("_").append(quantity).append("_").append(1, axis).append(unit);
  }
  return names;
}

}  // namespace

std::string forces_header() {
  std::string header = "tick,t_s";
  for (const auto hand_name : kHandNames) {
    const std::string hand(hand_name);
    for (const char* force : {"device_f", "world_f"})
      header += xyz(hand, force, "_N") + "," + hand + "_" + force + "_N";
    header += "," + hand + "_grip," + hand + "_node";
  }
  return header + ",state,fault,flags,session\n";
}

const std::string& forces_row(CsvRow& row, const ligature_msg::tick_t& tick, double t_s, int session) {
  row.add(tick.tick).add(t_s);
  for (std::size_t hand = 0; hand < 2; ++hand) {
    for (const auto* force : {&tick.f_device_N[hand], &tick.f_world_N[hand]})
      row.add_all(*force).add(magnitude(*force));
    row.add(static_cast<int>(tick.grip[hand])).add(tick.grasped_node[hand]);
  }
  return row.add(static_cast<int>(tick.state)).add(tick.fault).add(tick.flags).add(session).finish();
}

std::string forces_columns_help() {
  return "forces.csv, one row a tick:\n"
         "  tick, t_s                          number of the control period since the firmware's start; tick x period\n"
         "  HAND_device_f_x_N, _y_N, _z_N      force commanded to the device at the tip, after scale and limits, N;\n"
         "                                     axes x right, y away, z up; + pushes the hand along the axis\n"
         "  HAND_device_f_N                    its magnitude, N\n"
         "  HAND_world_f_x_N, _y_N, _z_N       force of the thread on the hand in world units, before force_scale, N\n"
         "  HAND_world_f_N                     its magnitude: the thread's tension at the hand, N\n"
         "  HAND_grip, HAND_node               grip button 0/1; thread node held, -1 none\n"
         "  state                              0 OFF 1 CALIBRATE 2 IDLE 3 ENGAGE 4 FORCE 5 BRAKE 6 FAULT\n"
         "  fault                              latched fault number, 0 none\n"
         "  flags                              sum of 1 period lost (values held), 2 deadline missed, 4/8 left/right\n"
         "                                     stale, 16/32 left/right force limited, 64 contact list full,\n"
         "                                     128 the loop itself computed for longer than the bus leaves time,\n"
         "                                     256 the thread was late, 512 the clock ended its tick\n"
         "  session                            1, 2, .. : run of the firmware within this log\n"
         "  HAND is left, then right.\n";
}

std::string ticks_header() {
  std::string header;
  for (const TickColumn& column : tick_columns()) {
    if (!header.empty()) header += ',';
    header += column.name;
    if (column.name == "tick") header += ",t_s";
  }
  return header + ",session\n";
}

const std::string& ticks_row(CsvRow& row, const ligature_msg::tick_t& tick, double t_s, int session) {
  for (const TickColumn& column : tick_columns()) {
    std::visit([&](const auto& value) { row.add(value(tick)); }, column.value);
    if (column.name == "tick") row.add(t_s);
  }
  return row.add(session).finish();
}

std::string ticks_columns_help() {
  return "ticks.csv, one row a tick: every field of tick_t (protocol/lcm/tick_t.lcm) with its unit in the column's "
         "name;\n"
         "  each is explained in ticks.csv-metadata.json (CSV on the Web), as are the others' columns in theirs, "
         "beside "
         "the\n"
         "  scene's text and the versions.\n";
}

std::string shape_header() { return "t_s,node,x_m,y_m,z_m\n"; }

const std::string& shape_row(CsvRow& row, const ligature_msg::thread_t& thread, double t_s, int node) {
  const auto& p_W_m = thread.p_W_m[static_cast<std::size_t>(node)];
  return row.add(t_s).add(node).add(p_W_m[0]).add(p_W_m[1]).add(p_W_m[2]).finish();
}

std::string shape_columns_help() {
  return "shape.csv, one row a node of every recorded shape (60 Hz): t_s,node,x_m,y_m,z_m in the world frame.\n";
}

}  // namespace ligature::host
