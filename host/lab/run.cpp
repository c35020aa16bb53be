#include "host/lab/run.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

#include "host/console/progress.hpp"
#include "host/console/stop_signal.hpp"
#include "host/lab/every.hpp"
#include "host/lab/run_files.hpp"
#include "host/lab/trace_row.hpp"
#include "protocol/scene/scene_file.hpp"

namespace ligature::lab {
namespace {

constexpr double kKnotEvery_s = 0.02;

TraceRow row_of(const Rehearsal& r) { return lab::row_of(r.simulation(), r.scene(), r.time_s(), r.last_tick_us()); }

void look_at_knot(RunSummary& s, const Rehearsal& r) {
  s.knot = knot_of(r.simulation());
  if (s.knot_history.empty() || s.knot_history.back().second != s.knot.type) {
    s.knot_history.emplace_back(r.time_s(), s.knot.type);
  }
}

void tally(RunSummary& s, const TraceRow& row) {
  s.max_stretch = std::max(s.max_stretch, row.max_stretch);
  s.min_gap_m = std::min(s.min_gap_m, row.min_gap_m);
  s.left_N.add(row.left_N.norm());
  s.right_N.add(row.right_N.norm());
}

void show(console::Progress& progress, const RunSummary& s, const Rehearsal& r, double duration_s) {
  std::ostringstream text;
  text.precision(4);
  text << r.time_s() << " of " << duration_s << " s, knot " << s.knot.type;
  progress.show(r.time_s() / duration_s, text.str());
}

}  // namespace

RunSummary run(Rehearsal& r, const RunOptions& options) {
  const auto& scene = r.scene();
  RunSummary s;
  s.model = scene::name(scene.suture.model);
  s.nodes = scene.suture.nodes;
  s.min_gap_m = scene.suture.length_m;
  make_folder(options.folder);
  check_outputs(options.folder, {"summary.json", "trace.csv", "shape.csv"});
  TraceFile trace(options.folder);
  ShapeFile shape(options.folder);
  console::Progress progress("run");
  Every shape_due(options.shape_every_s), knot_due(kKnotEvery_s);
  const auto ticks = static_cast<std::int64_t>(std::llround(options.duration_s / scene.time.tick_s));
  std::vector<double> step_us;
  shape.add(0.0, r.simulation().nodes_W());
  look_at_knot(s, r);
  bool shape_written = true;
  while (r.ticks() < ticks && !console::stop_requested()) {
    const bool good = r.tick();
    const auto row = row_of(r);
    if (!good || !row.is_finite()) {
      s.finite = false;
      s.failure = divergence(r.simulation().diagnostics(), scene, r.ticks(), r.time_s());
      break;
    }
    trace.add(row);
    tally(s, row);
    step_us.push_back(row.step_us);
    shape_written = shape_due.is_due(r.time_s(), scene.time.tick_s);
    if (shape_written) shape.add(r.time_s(), r.simulation().nodes_W());
    if (knot_due.is_due(r.time_s(), scene.time.tick_s)) look_at_knot(s, r);
    if (progress.is_due()) show(progress, s, r, options.duration_s);
  }
  s.interrupted = s.finite && r.ticks() < ticks;
  s.ticks = s.finite ? r.ticks() : r.ticks() - 1;
  s.duration_s = static_cast<double>(s.ticks) * scene.time.tick_s;
  if (!shape_written) shape.add(s.duration_s, r.simulation().nodes_W());
  if (s.finite) look_at_knot(s, r);
  s.max_penetration_diameters = std::max(0.0, -s.min_gap_m / (2.0 * scene.suture.radius_m));
  double spent_s = 0.0;
  for (const double us : step_us) spent_s += 1e-6 * us;
  s.realtime_factor = spent_s > 0.0 ? s.duration_s / spent_s : 0.0;
  s.step_us = spread_of(std::move(step_us));
  // None of the three replaces the one of an earlier run before all of them are whole: the disk may fill up.
  trace.finish();
  shape.finish();
  write_text(options.folder / "summary.json", to_json(s));
  trace.close();
  shape.close();
  return s;
}

std::string to_json(const RunSummary& s) {
  using Json = nlohmann::ordered_json;
  Json history = Json::array();
  for (const auto& [t_s, type] : s.knot_history) history.push_back({t_s, type});
  const Json json{
      {"model", s.model},
      {"nodes", s.nodes},
      {"ticks", s.ticks},
      {"duration_s", s.duration_s},
      {"finite", s.finite},
      {"interrupted", s.interrupted},
      {"knot", {{"type", s.knot.type}, {"handedness", s.knot.handedness}}},
      {"knot_history", history},
      {"max_stretch", s.max_stretch},
      {"min_gap_m", s.min_gap_m},
      {"max_penetration_diameters", s.max_penetration_diameters},
      {"hand_force_N",
       {{"left", {{"max", s.left_N.max}, {"mean", s.left_N.mean()}}},
        {"right", {{"max", s.right_N.max}, {"mean", s.right_N.mean()}}}}},
      {"step_us", {{"median", s.step_us.median}, {"p99", s.step_us.p99}, {"max", s.step_us.max}}},
      {"realtime_factor", s.realtime_factor},
  };
  return json.dump(1) + "\n";
}

}  // namespace ligature::lab
