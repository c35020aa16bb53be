#include "firmware/app/admit_command.hpp"

#include <algorithm>
#include <cstdio>

#include "firmware/platform/realtime.hpp"

namespace ligature::app {
namespace {

constexpr double kSearch_s = 2.0;

std::string nodes_that_would(const scene::Scene& scene, const Measure& measure) {
  const auto nodes = largest_nodes(scene, kSearch_s, measure);
  return nodes ? "largest suture.nodes that would: " + std::to_string(*nodes) : "no suture.nodes would";
}

/// What to change. A rod may be solved with less work: the same thread, other figures (docs/accuracy.md).
std::string remedies(scene::Scene scene, const Measure& measure) {
  std::string fewer = nodes_that_would(scene, measure);
  if (scene.suture.model != scene::Model::kRod || scene.suture.rod.accuracy == scene::Accuracy::kFast) return fewer;
  scene.suture.rod.accuracy = scene::Accuracy::kFast;
  if (measure(scene, kSearch_s / 4).fits()) return "suture.accuracy = \"fast\" would as it is; else " + fewer;
  return fewer + "; with suture.accuracy = \"fast\": " + nodes_that_would(scene, measure);
}

}  // namespace

std::optional<Refusal> objection_of(const Admission& admission, const scene::Scene& scene, const Measure& measure) {
  if (admission.fits()) return std::nullopt;
  char text[160];
  std::snprintf(text, sizeof text,
                "the scene does not fit: found %.0f us of computing in the worst tick, allowed %.0f; ",
                admission.computing_us(), std::min(admission.budget_us(), 1000.0 - admission.bus_us));
  return Refusal{3, text + remedies(scene, measure)};
}

int admit_scene(const AdmitOptions& options) {
  RunOptions like_run;
  like_run.scene = options.scene;
  like_run.overrides = options.overrides;
  const auto planned = make_plan(like_run);
  if (const auto* refusal = std::get_if<Refusal>(&planned)) {
    std::fprintf(stderr, "ligature-firmware: %s\n", refusal->text.c_str());
    return refusal->exit_code;
  }
  const auto& scene = std::get<Plan>(planned).scene;
  const Measure measure = measure_on(platform::realtime_core(), options.budget_percent);
  const Admission admission = measure(scene, options.seconds);
  std::fputs(table(admission).c_str(), stdout);
  const auto objection = objection_of(admission, scene, measure);
  if (!objection) {
    std::puts("admitted");
    return 0;
  }
  std::fflush(stdout);
  std::fprintf(stderr, "ligature-firmware: %s\n", objection->text.c_str());
  return objection->exit_code;
}

}  // namespace ligature::app
