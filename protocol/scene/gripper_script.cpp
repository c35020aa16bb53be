#include "protocol/scene/gripper_script.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <string>

#include "protocol/scene/csv.hpp"
#include "protocol/scene/monotone_cubic.hpp"

namespace ligature::scene {
namespace {

constexpr std::string_view kHeader = "time,hand,x,y,z,grip", kTurning = "time,hand,x,y,z,grip,turn_x,turn_y,turn_z";

/// Number with at most that many decimals, without trailing zeros. @pre |value| <= 1e9
std::string shortest(double value, int decimals) {
  std::array<char, 32> cell{};
  const auto end = std::to_chars(cell.data(), cell.data() + cell.size(), value, std::chars_format::fixed, decimals);
  std::string text(cell.data(), end.ptr);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text == "-0" ? "0" : text;
}

/// Reads the `motion` setting. @return empty, or what is wrong with it.
std::string read_motion(const CsvSetting& setting, Motion& motion) {
  if (setting.line == 0 || setting.value == "rests") return {};
  motion = Motion::kMonotoneCubic;
  if (setting.value == "monotone-cubic") return {};
  return "motion: found '" + shown(setting.value) + "', allowed rests or monotone-cubic";
}

/// Reads one row as a key of a hand. @return empty, or what is wrong with it.
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
  constexpr double kMost = 1e6;  // s, m, degrees; differences of such values stay finite
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
  CsvSetting motion{"motion"};
  auto read = read_csv(path, kHeader, kTurning, &motion);
  if (auto* error = std::get_if<Error>(&read)) return *error;
  if (auto why = read_motion(motion, script.motion); !why.empty()) return at_line(path, motion.line, why);
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
  if (script.motion == Motion::kMonotoneCubic)
    for (auto& keys : script.keys) pass_through(keys);
  return script;
}

std::string gripper_script_text(const GripperScript& script, const std::string& remark) {
  std::string text = "# " + remark + "\n";
  if (script.motion == Motion::kMonotoneCubic) text += "motion,monotone-cubic\n";
  text += std::string(script.turns ? kTurning : kHeader) + "\n";
  for (int hand = 0; hand < 2; ++hand) {
    for (const GripKey& key : script.keys[hand]) {
      text += shortest(key.time_s, 4) + (hand == 0 ? ",L" : ",R");
      for (const double x : key.p_W_m) text += "," + shortest(x, 6);
      text += key.grip ? ",1" : ",0";
      if (script.turns)
        for (const double turn : key.turn_deg) text += "," + shortest(turn, 3);
      text += '\n';
    }
  }
  return text;
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
  const double from = span_s * u * (1.0 - u) * (1.0 - u), to = -span_s * u * u * (1.0 - u);
  ToolPose pose{{}, {}, a.grip, {}};
  for (std::size_t i = 0; i < 3; ++i) {
    const double way = next->p_W_m[i] - a.p_W_m[i];
    const double v_a = a.v_W_m_per_s[i], v_b = next->v_W_m_per_s[i];
    pose.p_W_m[i] = a.p_W_m[i] + way * s + (from * v_a + to * v_b);
    pose.v_W_m_per_s[i] = way * ds_per_s + ((1.0 - u) * (1.0 - 3.0 * u) * v_a + u * (3.0 * u - 2.0) * v_b);
    pose.turn_deg[i] = a.turn_deg[i] + (next->turn_deg[i] - a.turn_deg[i]) * s +
                       (from * a.turn_deg_per_s[i] + to * next->turn_deg_per_s[i]);
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
