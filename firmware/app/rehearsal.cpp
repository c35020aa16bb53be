#include "firmware/app/rehearsal.hpp"

#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <exception>

#include "firmware/app/admission.hpp"
#include "firmware/app/rig_setup.hpp"
#include "firmware/platform/realtime.hpp"
#include "firmware/platform/sanitized.hpp"
#include "protocol/scene/text_file.hpp"

namespace ligature::app {
namespace {

constexpr rlim_t kMostMemory_bytes = rlim_t{1} << 30;
constexpr rlim_t kMostCpu_s = 6;
constexpr rlim_t kMostWords_bytes = 64 * 1024;
constexpr int kNiceness = 10;

/// Sets a resource limit of this process. For CPU time, the soft limit raises SIGXCPU, by which the parent knows the
/// cause; the hard limit, 1 s more, kills the process.
void limit(int what, rlim_t most) {
  const rlimit both{most, what == RLIMIT_CPU ? most + 1 : most};
  setrlimit(static_cast<__rlimit_resource>(what), &both);
}

/// Largest size of a file that this process may write to. With 0, SIGXFSZ would end the process at its first word where
/// stderr is a file, and the reason of a refusal would be lost. The file may hold other text already.
rlim_t most_file_bytes() {
  struct stat found {};
  const bool is_file = fstat(STDERR_FILENO, &found) == 0 && S_ISREG(found.st_mode);
  return kMostWords_bytes + (is_file ? static_cast<rlim_t>(found.st_size) : 0);
}

/// Limits this process's memory, CPU time and files, so that no scene can exhaust the machine. Builds with sanitizers
/// have no limit on memory and CPU time, because the sanitizers' own use would count.
void bound_this_process() {
#ifndef LIGATURE_SANITIZED
  limit(RLIMIT_AS, kMostMemory_bytes);
  limit(RLIMIT_CPU, kMostCpu_s);
#endif
  limit(RLIMIT_CORE, 0);
  limit(RLIMIT_FSIZE, most_file_bytes());
  setpriority(PRIO_PROCESS, 0, kNiceness);
  prctl(PR_SET_PDEATHSIG, SIGKILL);  // die with the parent: the verdict would have no reader
}

int refused(const Refusal& why) {
  std::fprintf(stderr, "ligature-firmware: %s\n", why.text.c_str());
  return why.exit_code;
}

int try_out(const RehearseOptions& options) {
  const auto text =
      scene::read_text(options.text_from.empty() ? options.scene : options.text_from, scene::kMostScene_bytes);
  if (const auto* error = std::get_if<scene::Error>(&text)) return refused({2, error->text});
  auto planned = plan_of(options.scene, std::get<std::string>(text), options.overrides);
  if (const auto* refusal = std::get_if<Refusal>(&planned)) return refused(*refusal);
  const Plan& plan = std::get<Plan>(planned);
  if (const auto why = rehearse(plan.thread); !why.empty()) return refused({2, options.scene + ": " + why});
  if (options.no_loss_m_per_s == 0.0) return 0;
  const auto excess =
      objection_of(admit(plan.scene, {.draw_knots = true, .device = plan.device}), options.no_loss_m_per_s);
  return excess ? refused({3, options.scene + ": " + *excess}) : 0;
}

}  // namespace

std::string rehearse(const physics::Simulation& thread) {
  constexpr int kTicks = 400;
  constexpr double kTorn = 5.0;
  physics::Simulation copy = thread;
  const auto n = copy.nodes_W().size();
  const physics::Vec3 start[2] = {copy.nodes_W()[n / 3], copy.nodes_W()[2 * n / 3]};
  const double reach_m = 0.2 * (start[1] - start[0]).norm();
  for (int tick = 0; tick < kTicks; ++tick) {
    const double swing = std::sin(6.283185307179586 * tick / kTicks);
    const physics::Vec3 pull(reach_m * swing, 0.0, 0.0);
    copy.tick({physics::ToolInput{start[0] - pull, physics::Vec3::Zero(), true},
               physics::ToolInput{start[1] + pull, physics::Vec3::Zero(), true}});
    if (!copy.diagnostics().finite || copy.diagnostics().max_stretch > kTorn)
      return "the thread would become unstable (rehearsal of " + std::to_string(kTicks) + " ticks, tick " +
             std::to_string(tick) + ")";
  }
  return {};
}

int rehearse_scene(const RehearseOptions& options) {
  bound_this_process();
  platform::flush_denormals();
  try {
    return try_out(options);
  } catch (const std::exception& error) {  // mostly out of memory
    return refused({2, options.scene + ": cannot be built within 1 GB of memory (" + error.what() + ")"});
  }
}

}  // namespace ligature::app
