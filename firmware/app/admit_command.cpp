#include "firmware/app/admit_command.hpp"

#include <algorithm>
#include <cstdio>

#include "firmware/platform/realtime.hpp"

namespace ligature::app {
namespace {

constexpr double kSearch_s = 2.0;

/// A rod may be solved with less work: the same thread, other figures (docs/accuracy.md).
bool fast_would_fit(scene::Scene scene, int core, double budget_percent) {
  const bool has_less = scene.suture.model == scene::Model::kRod && scene.suture.rod.accuracy != scene::Accuracy::kFast;
  if (!has_less) return false;
  scene.suture.rod.accuracy = scene::Accuracy::kFast;
  return admit(scene, kSearch_s / 4, core, budget_percent).fits();
}

}  // namespace

std::optional<Refusal> objection_of(const Admission& admission, const scene::Scene& scene, int core) {
  if (admission.fits()) return std::nullopt;
  char text[160];
  std::snprintf(text, sizeof text,
                "the scene does not fit: found %.0f us of computing in the worst tick, allowed %.0f; ",
                admission.computing_us(), std::min(admission.budget_us(), 1000.0 - admission.bus_us));
  const auto nodes = largest_nodes(scene, kSearch_s, core, admission.budget_percent);
  const std::string remedy =
      nodes ? "largest suture.nodes that would: " + std::to_string(*nodes) : "no suture.nodes would";
  const bool fast = fast_would_fit(scene, core, admission.budget_percent);
  return Refusal{3, text + remedy + (fast ? "; as it is suture.accuracy = \"fast\" would" : "")};
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
  const int core = platform::realtime_core();
  const Admission admission = admit(scene, options.seconds, core, options.budget_percent);
  std::fputs(table(admission).c_str(), stdout);
  const auto objection = objection_of(admission, scene, core);
  if (!objection) {
    std::puts("admitted");
    return 0;
  }
  std::fflush(stdout);
  std::fprintf(stderr, "ligature-firmware: %s\n", objection->text.c_str());
  return objection->exit_code;
}

}  // namespace ligature::app
