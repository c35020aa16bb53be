#include "protocol/scene/gripper_script.hpp"

#include <algorithm>
#include <string>

#include "protocol/scene/csv.hpp"

namespace ligature::scene {
namespace {

constexpr std::string_view kHeader = "time,hand,x,y,z,grip", kTurning = "time,hand,x,y,z,grip,turn_x,turn_y,turn_z";

/// One row as a key of one hand; the text says what is wrong with it, empty when nothing is.
std::string read_row(const CsvRow& row, int& hand, GripKey& key) {
  constexpr const char* kNumbers[] = {"time", "x", "y", "z", "turn_x", "turn_y", "turn_z"};
  constexpr std::size_t kCells[] = {0, 2, 3, 4, 6, 7, 8};
  double* const out[] = {&key.time_s,      &key.p_W_m[0],    &key.p_W_m[1],   &key.p_W_m[2],
                         &key.turn_deg[0], &key.turn_deg[1], &key.turn_deg[2]};
  const std::size_t numbers = row.cells.size() > 6 ? 7 : 4;
  for (std::size_t i = 0; i < numbers; ++i) {
    const auto& cell = row.cells[kCells[i]];
    if (!parse_number(cell, *out[i])) {
      return std::string("column '") + kNumbers[i] + "': found '" + shown(cell) + "', allowed a finite number";
    }
  }
  constexpr double kMost = 1e6;  // s, m, degrees: differences of these are numbers too
  for (std::size_t i = 0; i < numbers; ++i) {
    const double least = i == 0 ? 0.0 : -kMost;
    if (*out[i] < least || *out[i] > kMost)
      return std::string("column '") + kNumbers[i] + "': found " + shown(row.cells[kCells[i]]) + ", allowed " +
             (i == 0 ? "0" : "-1e6") + " .. 1e6";
  }
  if (row.cells[1] != "L" && row.cells[1] != "R")
    return "column 'hand': found '" + shown(row.cells[1]) + "', allowed L or R";
  if (row.cells[5] != "0" && row.cells[5] != "1")
    return "column 'grip': found '" + shown(row.cells[5]) + "', allowed 0 or 1";
  hand = row.cells[1] == "L" ? 0 : 1;
  key.grip = row.cells[5] == "1";
  return {};
}

}  // namespace

std::variant<GripperScript, Error> load_gripper_script(const std::filesystem::path& path) {
  GripperScript script;
  auto read = read_csv(path, kHeader, kTurning);
  if (auto* error = std::get_if<Error>(&read)) return *error;
  const auto& rows = std::get<std::vector<CsvRow>>(read);
  script.turns = rows.front().cells.size() > split(kHeader).size();
  for (const auto& row : rows) {
    int hand = 0;
    GripKey key;
    if (auto why = read_row(row, hand, key); !why.empty()) return at_line(path, row.line, why);
    auto& keys = script.keys[hand];
    if (!keys.empty() && key.time_s <= keys.back().time_s) {
      return at_line(path, row.line,
                     "column 'time': found " + shown(row.cells[0]) + ", allowed later than the row of hand " +
                         row.cells[1] + " before it");
    }
    keys.push_back(key);
  }
  return script;
}

ToolPose sample(std::span<const GripKey> keys, double t_s) noexcept {
  if (keys.empty()) return {kParked_W_m, {}, false};
  const auto next =
      std::upper_bound(keys.begin(), keys.end(), t_s, [](double t, const GripKey& k) { return t < k.time_s; });
  if (next == keys.begin()) return {next->p_W_m, {}, false, next->turn_deg};
  const auto& a = *(next - 1);
  if (next == keys.end()) return {a.p_W_m, {}, a.grip, a.turn_deg};
  const double span_s = next->time_s - a.time_s;
  const double u = (t_s - a.time_s) / span_s;
  const double s = u * u * (3.0 - 2.0 * u);
  const double ds_per_s = 6.0 * u * (1.0 - u) / span_s;
  ToolPose pose{{}, {}, a.grip, {}};
  for (std::size_t i = 0; i < 3; ++i) {
    const double way = next->p_W_m[i] - a.p_W_m[i];
    pose.p_W_m[i] = a.p_W_m[i] + way * s;
    pose.v_W_m_per_s[i] = way * ds_per_s;
    pose.turn_deg[i] = a.turn_deg[i] + (next->turn_deg[i] - a.turn_deg[i]) * s;
  }
  return pose;
}

double end_time_s(const GripperScript& script) noexcept {
  double end_s = 0.0;
  for (const auto& keys : script.keys) {
    if (!keys.empty()) end_s = std::max(end_s, keys.back().time_s);
  }
  return end_s;
}

}  // namespace ligature::scene
