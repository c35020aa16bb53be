#include "host/lab/rehearsal.hpp"

#include <utility>

#include "host/lab/cpu_time.hpp"
#include "host/lab/script_tools.hpp"
#include "host/lab/validate/proceed.hpp"

namespace ligature::lab {

Rehearsal::Rehearsal(const scene::Scene& scene, scene::GripperScript script, const std::string& scene_name)
    : scene_(scene),
      script_(std::move(script)),
      simulation_(make_or_refuse(scene, scene_name)),
      tick_s_(scene.time.tick_s) {}

std::array<physics::ToolInput, 2> Rehearsal::tools_at(double t_s) {
  if (!tier_) return lab::tools_at(script_, t_s);
  sim::Sight sight;
  sight.t_s = t_s;
  sight.thread_W = simulation_.nodes_W();
  for (std::size_t h = 0; h < 2; ++h) {
    sight.tool_W[h] = tier_->wish()[h].p_W;
    const auto& hand = simulation_.hand(static_cast<physics::Hand>(h));
    sight.force_W_N[h] = hand.f_W;
    sight.holds[h] = hand.node >= 0;
  }
  const auto& wish = tier_->tick(sight);
  return {physics::ToolInput{wish[0].p_W, wish[0].v_W, wish[0].grip},
          physics::ToolInput{wish[1].p_W, wish[1].v_W, wish[1].grip}};
}

bool Rehearsal::tick() {
  validate::heed_stop();
  const double t_s = static_cast<double>(ticks_ + 1) * tick_s_;
  const auto tools = tools_at(t_s);
  const double from_us = thread_cpu_us();
  simulation_.tick(tools);
  last_tick_us_ = thread_cpu_us() - from_us;
  ++ticks_;
  return simulation_.diagnostics().finite;
}

bool Rehearsal::run_until(double t_s) {
  while (time_s() + 0.5 * tick_s_ < t_s) {
    if (!tick()) return false;
  }
  return true;
}

knot::KnotResult knot_of(const physics::Simulation& simulation) {
  std::vector<std::array<double, 3>> line;
  for (const auto& p : simulation.nodes_W()) line.push_back({p.x(), p.y(), p.z()});
  return knot::recognise(line, false);
}

}  // namespace ligature::lab
