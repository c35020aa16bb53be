#include "synthetic_log.hpp"

#include <stdlib.h>

#include <cmath>
#include <fstream>
#include <numbers>
#include <sstream>

namespace ligature::host::test {

namespace fs = std::filesystem;

TestFolder::TestFolder() {
  std::string name = (fs::temp_directory_path() / "ligature-host-test-XXXXXX").string();
  if (!mkdtemp(name.data())) throw std::runtime_error("no test folder");
  path_ = name;
}

TestFolder::~TestFolder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

ligature_msg::tick_t tick_of(std::int64_t number) {
  ligature_msg::tick_t tick{};
  tick.tick = number;
  tick.scheduled_ns = number * 1'000'000;
  tick.grasped_node[0] = tick.grasped_node[1] = -1;
  return tick;
}

ligature_msg::tick_batch_t batch_of(std::int64_t session, std::int64_t first, int count) {
  ligature_msg::tick_batch_t batch{};
  batch.utime = session + first * 1000;
  batch.session = session;
  batch.count = count;
  for (int i = 0; i < count; ++i) batch.ticks.push_back(tick_of(first + i));
  return batch;
}

ligature_msg::thread_t thread_of(std::int64_t tick, const std::vector<std::array<double, 3>>& points) {
  ligature_msg::thread_t thread{};
  thread.tick = tick;
  thread.radius_m = 0.05F;
  thread.count = static_cast<std::int32_t>(points.size());
  for (const auto& p : points)
    thread.p_W_m.push_back({static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2])});
  thread.tension_N.resize(points.size());
  thread.turn_rad.resize(points.size());
  thread.grasped_node[0] = thread.grasped_node[1] = -1;
  return thread;
}

/// The trefoil (2 + cos 3t)(cos 2t, sin 2t), sin 3t, cut at an outer point; both ends are led far away from there.
std::vector<std::array<double, 3>> overhand_points(int count) {
  std::vector<std::array<double, 3>> points;
  constexpr double kCut = 0.05;
  for (int i = 0; i < count; ++i) {
    const double t = kCut + (2.0 * std::numbers::pi - 2.0 * kCut) * i / (count - 1);
    const double r = 2.0 + std::cos(3.0 * t);
    points.push_back({r * std::cos(2.0 * t), r * std::sin(2.0 * t), std::sin(3.0 * t)});
  }
  points.insert(points.begin(), {20.0, -1.0, 0.0});
  points.push_back({20.0, 1.0, 0.0});
  return points;
}

std::vector<std::array<double, 3>> straight_points(int count) {
  std::vector<std::array<double, 3>> points;
  for (int i = 0; i < count; ++i) points.push_back({0.0, 0.0, 5.5 - 0.1 * i});
  return points;
}

std::string text_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

std::vector<std::string> lines_of(const std::string& path) {
  std::istringstream text(text_of(path));
  std::vector<std::string> lines;
  for (std::string line; std::getline(text, line);) lines.push_back(line);
  return lines;
}

void write_text(const std::string& path, std::string_view text) { std::ofstream(path, std::ios::binary) << text; }

}  // namespace ligature::host::test
