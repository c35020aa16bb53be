#include "host/lab/pareto/trials.hpp"

#include <cmath>
#include <limits>
#include <map>

#include "host/knot/recognise.hpp"
#include "host/lab/cpu_time.hpp"
#include "host/lab/validate/overhand.hpp"
#include "host/lab/validate/proceed.hpp"

namespace ligature::lab {
namespace {

using physics::Hand;
using physics::Vec3;
using validate::Tools;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// The free end's motion after a release from the horizontal with one end fixed: the first 0.5 s (rod) or 2 s (5 m of
/// paper thread).
std::vector<Vec3> swing_of(const Setting& setting) {
  auto scene = thread_of(setting);
  scene.contact.solver = scene::ContactSolver::kNone;
  scene.suture.rod.spacing = scene::Spacing::kUniform;
  scene.world.fixed.push_back({0, {0, 0, 0}, std::nullopt});
  Specimen thread(scene, setting);
  const int every = setting.model == scene::Model::kRod ? 10 : 40;
  std::vector<Vec3> end;
  for (int k = 1; k <= 20 * every; ++k) {
    validate::proceed(thread, validate::no_hands());
    if (k % every == 0) end.push_back(thread.nodes_W().back());
  }
  return end;
}

struct Pull {
  double loop_m, speed_m_per_s, force_N;
};
Pull pull_of(scene::Model m) { return m == scene::Model::kRod ? Pull{0.0138, 0.2, 1.0} : Pull{0.45, 0.5, 30.0}; }

/// Pulls a loose overhand knot with both hands until a given force is reached, then holds it.
void pull_knot(const Setting& setting, int cost_only, Traces& t) {
  auto scene = thread_of(setting);
  scene.world.gravity_m_per_s2 = {0, 0, 0};
  const Pull pull = pull_of(setting.model);
  validate::lay_overhand(scene, pull.loop_m);
  Specimen thread(scene, setting);
  Tools tools = validate::no_hands();
  tools[0] = {thread.nodes_W().front(), Vec3::Zero(), true};
  tools[1] = {thread.nodes_W().back(), Vec3::Zero(), true};
  t.grip_m = scene.suture.length_m;
  const double step = scene.time.tick_s * pull.speed_m_per_s;
  const int settle = 100, most = cost_only > 0 ? cost_only : 6000, hold = 300;
  int held = 0;
  for (int k = 0; k < most && held < hold && thread.diagnostics().finite; ++k) {
    const double force = 0.5 * (thread.hand(Hand::kLeft).f_W.x() - thread.hand(Hand::kRight).f_W.x());
    const bool pulling = held == 0 && k >= settle && force < pull.force_N;
    held += !pulling && k >= settle;
    for (std::size_t h = 0; h < 2; ++h) {
      const double sense = h == 0 ? -1.0 : 1.0;
      tools[h].v_WT.x() = pulling ? sense * pull.speed_m_per_s : 0.0;
      if (pulling) tools[h].p_WT.x() += sense * step;
    }
    validate::heed_stop();
    const double before = thread_cpu_us();
    measured_tick(thread, tools);
    t.us.push_back(thread_cpu_us() - before);
    t.penetration = std::max(t.penetration, -thread.diagnostics().min_gap_m / (2.0 * scene.suture.radius_m));
  }
  t.finite = thread.diagnostics().finite;
  t.hold_m = held >= hold ? (thread.nodes_W().back() - thread.nodes_W().front()).norm() : kNan;
  if (cost_only > 0) return;
  std::vector<std::array<double, 3>> points;
  for (const auto& p : thread.nodes_W()) points.push_back({p.x(), p.y(), p.z()});
  t.knot = knot::recognise(points, false).type;
}

/// Largest error of the validation cases for elastica and catenary: position errors relative to the length L, other
/// quantities relative to themselves. NaN for explicit models beyond 50 nodes, which would take minutes.
double static_error(const Setting& setting) {
  if (setting.model != scene::Model::kRod && setting.nodes > 50) return kNan;
  double worst = 0.0;
  for (const char* name : {"elastica-tip", "catenary"}) {
    const auto* c = validate::find_case(name);
    if (!c->is_modelled(setting.model)) continue;
    for (const auto& f : c->examine({setting.model, setting.nodes})) worst = std::max(worst, f.error);
  }
  return worst;
}

}  // namespace

Traces run_trials(const Setting& setting, int cost_only) {
  Traces t;
  if (cost_only == 0) t.swing = swing_of(setting);
  pull_knot(setting, cost_only, t);
  return t;
}

Errors errors_of(const Setting& setting, const Traces& mine, const Traces& finest) {
  Errors e;
  static std::map<std::pair<scene::Model, int>, double> statics;  // cached: independent of the time step
  const auto key = std::pair(setting.model, setting.nodes);
  if (!statics.contains(key)) statics[key] = static_error(setting);
  e.shape = statics[key];
  double sum = 0.0;
  for (std::size_t i = 0; i < mine.swing.size(); ++i) sum += (mine.swing[i] - finest.swing[i]).squaredNorm();
  e.swing = std::sqrt(sum / static_cast<double>(mine.swing.size())) / mine.grip_m;
  const double diameter = setting.model == scene::Model::kRod ? 3e-4 : 0.1;
  e.knot = mine.finite && mine.knot == "3_1" ? std::abs(mine.hold_m - finest.hold_m) / diameter : kNan;
  return e;
}

}  // namespace ligature::lab
