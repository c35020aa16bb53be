#include "sim_device/tying/tying_plan.hpp"

#include <algorithm>
#include <cmath>

namespace ligature::sim {
namespace {

Vec3 vec(const double (&a)[3]) { return {a[0], a[1], a[2]}; }

bool is_sound(const ligature_msg::tick_t& t) {
  const auto sound = [&](std::size_t h) {
    return vec(t.p_WT_m[h]).allFinite() && vec(t.f_device_N[h]).allFinite() && std::isfinite(t.gain[h]);
  };
  return sound(0) && sound(1);
}

bool both_push(const ligature_msg::tick_t& t) { return t.gain[0] >= 1.0 && t.gain[1] >= 1.0; }

}  // namespace

void TyingPlan::take(const ligature_msg::thread_t& thread) {
  const auto sound = [](const std::vector<float>& p) {
    return std::ranges::all_of(p, [](float x) { return std::isfinite(x); });
  };
  if (thread.p_W_m.size() < 2 || !std::ranges::all_of(thread.p_W_m, sound)) return;
  thread_W_.clear();
  for (const auto& p : thread.p_W_m) thread_W_.emplace_back(p[0], p[1], p[2]);
  sight_.thread_W = thread_W_;
}

void TyingPlan::take(const ligature_msg::tick_batch_t& batch, std::vector<WishedTick>& wishes) {
  if (!std::ranges::all_of(batch.ticks, is_sound)) return;
  if (batch.session != session_) {
    if (has_begun_) return;
    session_ = batch.session;
    last_tick_ = -1;
  }
  for (const auto& tick : batch.ticks) {
    if (tick.tick <= last_tick_) continue;
    if (has_begun_) pass_blindly(tick.tick - last_tick_ - 1);
    has_begun_ = has_begun_ || both_push(tick);
    feel(tick);
    last_tick_ = tick.tick;
    if (has_begun_) tier_.tick(sight_);
    wishes.push_back({tick.scheduled_ns, tier_.wish(), tier_.is_done()});
  }
}

/// Continues the plan through lost ticks, with what was seen last.
void TyingPlan::pass_blindly(std::int64_t ticks) {
  lost_ += ticks;
  for (std::int64_t k = 0; k < std::min(ticks, kMostBlind); ++k) tier_.tick(sight_);
}

void TyingPlan::feel(const ligature_msg::tick_t& tick) {
  for (std::size_t h = 0; h < 2; ++h) {
    sight_.tool_W[h] = vec(tick.p_WT_m[h]);
    sight_.holds[h] = tick.grasped_node[h] >= 0;
    if (force_scale_ > 0.0) sight_.force_W_N[h] = vec(tick.f_device_N[h]) / force_scale_;
  }
}

}  // namespace ligature::sim
