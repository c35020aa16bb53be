#include "firmware/app/admit_command.hpp"

#include <algorithm>
#include <cstdio>
#include <tuple>

#include "firmware/app/admission.hpp"
#include "firmware/app/rig_setup.hpp"
#include "firmware/platform/realtime.hpp"

namespace ligature::app {
namespace {

constexpr double kLoses = 0.001;  // share of time lost below which nothing is printed

/// Largest share of time lost while a knot is drawn tight or held, over all hand speeds.
double most_lost(const Admission& a) {
  double most = 0.0;
  for (const auto& knot : a.knots) most = std::max({most, knot.pull_lost, knot.hold_lost});
  return most;
}

/// If the suture's physics loses time, measures again with fewer substeps per tick, and prints whether it then loses
/// less.
void tell_what_loses_less(scene::Scene scene, const Admission& found, const AdmissionSettings& settings) {
  auto& accuracy = scene.suture.rod.accuracy;
  if (most_lost(found) < kLoses || scene.suture.model != scene::Model::kRod || accuracy == scene::Accuracy::kFast)
    return;
  accuracy = scene::Accuracy::kFast;
  const double fast = most_lost(admit(scene, settings));
  if (fast < most_lost(found))
    std::printf("suture.accuracy = \"fast\" would lose at most %.1f %% (here %.1f %%)\n", 100.0 * fast,
                100.0 * most_lost(found));
}

}  // namespace

int admit_scene(const AdmitOptions& options) {
  RunOptions like_run;
  like_run.scene = options.scene;
  like_run.overrides = options.overrides;
  like_run.device = options.device;
  like_run.accept_no_drive_watchdog = true;  // nothing is moved here
  const auto planned = make_plan(like_run);
  if (const auto* refusal = std::get_if<Refusal>(&planned)) {
    std::fprintf(stderr, "ligature-firmware: %s\n", refusal->text.c_str());
    return refusal->exit_code;
  }
  const auto& [scene, device] = std::tie(std::get<Plan>(planned).scene, std::get<Plan>(planned).device);
  const auto drivers = measure_drivers(options.can, device);
  if (const auto* why = std::get_if<std::string>(&drivers)) {
    std::fprintf(stderr, "ligature-firmware: %s\n", why->c_str());
    return 2;
  }
  const AdmissionSettings settings{options.seconds, platform::realtime_core(),    options.budget_percent, true,
                                   device,          std::get<DriverTime>(drivers)};
  const Admission admission = admit(scene, settings);
  std::fputs(table(admission).c_str(), stdout);
  const auto objection = objection_of(admission, options.no_loss_m_per_s);
  if (!objection) {
    tell_what_loses_less(scene, admission, settings);
    std::puts("admitted");
    return 0;
  }
  std::fflush(stdout);
  std::fprintf(stderr, "ligature-firmware: %s: %s\n", options.scene.c_str(), objection->c_str());
  return 3;
}

}  // namespace ligature::app
