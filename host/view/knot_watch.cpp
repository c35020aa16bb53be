#include "host/view/knot_watch.hpp"

#include <cmath>

#include "host/thread_knot.hpp"
#include "host/view/rig_json.hpp"

namespace ligature::host::view {
namespace {

using nlohmann::json;
using Clock = std::chrono::steady_clock;
constexpr auto kPeriod = std::chrono::milliseconds(50);
constexpr auto kCorePeriod = std::chrono::milliseconds(500);

double length(std::span<const std::array<double, 3>> points) {
  double sum = 0.0;
  for (std::size_t i = 1; i < points.size(); ++i)
    sum +=
        std::hypot(points[i][0] - points[i - 1][0], points[i][1] - points[i - 1][1], points[i][2] - points[i - 1][2]);
  return sum;
}

}  // namespace

KnotCore find_core(std::span<const std::array<double, 3>> points, const knot::KnotResult& whole) {
  if (whole.type == "0_1" || whole.type == "unknown" || points.size() < 5) return {};
  const auto is_same = [&](std::size_t first, std::size_t last) {
    const auto piece = knot::recognise(points.subspan(first, last - first + 1), false);
    return piece.type == whole.type && piece.handedness == whole.handedness;
  };
  KnotCore core{0, points.size() - 1};
  // bisection for the smallest last node that keeps the knot
  for (std::size_t low = core.first, high = core.last; low + 1 < high;) {
    const std::size_t middle = (low + high) / 2;
    (is_same(0, middle) ? high : low) = middle;
    core.last = high;
  }
  for (std::size_t low = 0, high = core.last; low + 1 < high;) {
    const std::size_t middle = (low + high) / 2;
    (is_same(middle, core.last) ? low : high) = middle;
    core.first = low;
  }
  return core;
}

KnotWatch::KnotWatch(Picture& picture)
    : picture_(picture), thread_([this](const std::stop_token& stop) { watch(stop); }) {}

void KnotWatch::watch(const std::stop_token& stop) {
  std::int64_t known = 0;
  KnotCore core;
  std::string named;
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
    if (Clock::now() >= core_due || name != named) {
      core = find_core(points, found);
      core_due = Clock::now() + kCorePeriod;
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
      const double core_m = length(std::span(points).subspan(core.first, core.last - core.first + 1));
      knot["core"] = {core.first, core.last};
      knot["core_diameters"] = core_m / (2.0 * static_cast<double>(shape->radius_m));
    }
    picture_.set("knot", std::move(knot));
    if (name != named && !named.empty())
      picture_.add_event(
          {{"tick", shape->tick}, {"kind", kKnotEvent}, {"hand", -1}, {"code", 0}, {"text", "knot " + name}});
    named = name;
  }
}

}  // namespace ligature::host::view
