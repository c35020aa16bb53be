#include "host/view/knot_watch.hpp"

#include <cmath>
#include <span>
#include <string>
#include <vector>

#include "host/thread_knot.hpp"
#include "host/view/knot_core.hpp"
#include "host/view/rig_json.hpp"

namespace ligature::host::view {
namespace {

using nlohmann::json;
using Clock = std::chrono::steady_clock;
constexpr auto kPeriod = std::chrono::milliseconds(50);
constexpr auto kCorePeriod = std::chrono::milliseconds(500);

/// Length of a piece of the thread in diameters of the thread.
double length_d(std::span<const std::array<double, 3>> thread, KnotCore piece, double radius_m) {
  const auto points = thread.subspan(piece.first, piece.last - piece.first + 1);
  double sum = 0.0;
  for (std::size_t i = 1; i < points.size(); ++i)
    sum +=
        std::hypot(points[i][0] - points[i - 1][0], points[i][1] - points[i - 1][1], points[i][2] - points[i - 1][2]);
  return sum / (2.0 * radius_m);
}

}  // namespace

KnotWatch::KnotWatch(Picture& picture)
    : picture_(picture), thread_([this](const std::stop_token& stop) { watch(stop); }) {}

void KnotWatch::watch(const std::stop_token& stop) {
  std::int64_t known = 0;
  KnotCore core;
  std::vector<KnotCore> throws;
  std::string named;
  std::size_t nodes = 0;
  auto core_due = Clock::now();
  for (auto due = Clock::now(); !stop.stop_requested(); std::this_thread::sleep_until(due)) {
    due = std::max(due + kPeriod, Clock::now());
    const auto shape = picture_.newer_shape(known);
    if (!shape) continue;
    const auto points = points_of(*shape);
    const auto began = Clock::now();
    const auto found = knot::recognise(points, false);
    const double cost_ms = std::chrono::duration<double, std::milli>(Clock::now() - began).count();
    const std::string name = found.type + " " + found.handedness;
    if (Clock::now() >= core_due || name != named || points.size() != nodes) {
      core = find_core(points, found);
      throws = find_throws(points, found, core);
      core_due = Clock::now() + kCorePeriod;
      nodes = points.size();
    }
    json knot = {{"tick", shape->tick},
                 {"type", found.type},
                 {"handedness", found.handedness},
                 {"crossings", found.crossings},
                 {"determinant", found.determinant},
                 {"alexander", found.alexander},
                 {"cost_ms", cost_ms}};
    // null: could not be computed
    if (found.alexander.empty()) knot["crossings"] = knot["determinant"] = knot["alexander"] = nullptr;
    if (core.last > core.first) {
      const auto radius_m = static_cast<double>(shape->radius_m);
      knot["core"] = {core.first, core.last};
      knot["core_diameters"] = length_d(points, core, radius_m);
      for (const KnotCore& one : throws)
        knot["throws"].push_back({{"nodes", {one.first, one.last}}, {"diameters", length_d(points, one, radius_m)}});
    }
    picture_.set("knot", std::move(knot));
    if (name != named && !named.empty())
      picture_.add_event(
          {{"tick", shape->tick}, {"kind", kKnotEvent}, {"hand", -1}, {"code", 0}, {"text", "knot " + name}});
    named = name;
  }
}

}  // namespace ligature::host::view
