#include "host/lab/rerun/thread_player.hpp"

#include <algorithm>
#include <utility>

#include "firmware/control/tick_report.hpp"
#include "firmware/telemetry/messages.hpp"
#include "host/lab/cpu_time.hpp"

namespace ligature::lab {
namespace {

using ligature_msg::tick_t;

physics::ToolInput tool_of(const tick_t& t, std::size_t hand) {
  return {physics::Vec3(t.tool_p_W_m[hand]), physics::Vec3(t.tool_v_W_m_per_s[hand]), t.tool_grip[hand] != 0, {}};
}

control::ThreadOrders orders_of(const tick_t& t) { return {t.thread_resets, t.thread_scenes, t.thread_parameters}; }

bool is_lost(const tick_t& t) { return (t.flags & tick_t::FLAG_PERIOD_LOST) != 0; }

}  // namespace

ThreadPlayer::ThreadPlayer(std::vector<PlayedScene> scenes, bool cuts)
    : scenes_(std::move(scenes)), cuts_(cuts), told_(telemetry::to_message(rt::TickRecord{})) {}

void ThreadPlayer::forget(const std::string& why) {
  thread_.reset();
  orders_.reset();
  requests_.clear();
  why_unknown_ = why;
}

std::optional<tick_t> ThreadPlayer::take(const tick_t& tick) {
  cost_us_.reset();
  if (next_tick_ < 0 && tick.tick == 0) {  // the run starts here: its scene defines the thread's state
    thread_ = made(0);
    orders_ = control::ThreadOrders{};
  } else if (tick.tick != next_tick_) {
    forget("the ticks before " + std::to_string(tick.tick) + " are missing");
  }
  next_tick_ = tick.tick + 1;
  if (!is_lost(tick)) remember(tick);
  if (tick.thread_steps < 0 || tick.thread_steps > static_cast<int>(rt::kThreadSteps))
    forget("tick " + std::to_string(tick.tick) + " tells of " + std::to_string(tick.thread_steps) +
           " ticks of the thread");
  else
    for (int i = 0; i < tick.thread_steps; ++i) step(tick.tick - tick.step_age_ticks[i], tick.step_cut_at[i]);
  if (!thread_) return std::nullopt;
  tick_t again = tick;
  put_thread(again);
  told_ = again;
  return again;
}

void ThreadPlayer::remember(const tick_t& tick) {
  requests_.push_back({tick.tick, {tool_of(tick, 0), tool_of(tick, 1)}, orders_of(tick)});
}

/// Repeats the thread's tick for that period; requests of older periods were skipped by the firmware, too.
void ThreadPlayer::step(std::int64_t tick, int cut_at) {
  while (!requests_.empty() && requests_.front().tick < tick) requests_.pop_front();
  if (requests_.empty() || requests_.front().tick != tick)
    return forget("the tools of tick " + std::to_string(tick) + " are missing");
  const Request request = requests_.front();
  requests_.pop_front();
  obey(request, cut_at);
  last_step_ = tick;
}

/// Carries out a request as ThreadContext::compute() does.
void ThreadPlayer::obey(const Request& request, int cut_at) {
  const auto& now = request.orders;
  const auto was = std::exchange(orders_, now);
  if (!was) return;  // the orders before are unknown, so that resets and scene changes cannot be detected
  if (now.resets != was->resets) {
    if (!thread_) thread_ = made(current_ = scene_at(last_step_));
    thread_->reset();
  }
  const bool changes_scene = now.scenes != was->scenes;
  if ((changes_scene || now.parameters != was->parameters) && !take_scene(request, !changes_scene)) return;
  if (!thread_) return;
  if (!changes_scene) {
    const double from_us = thread_cpu_us();
    thread_->tick(request.tools,
                  cuts_ && cut_at >= 0 ? physics::TimeLeft::until_question(cut_at) : physics::TimeLeft{});
    cost_us_ = cost_us_.value_or(0.0) + thread_cpu_us() - from_us;
  }
  note_result(request.tick);
}

/// Builds the thread of the scene in force at the request's tick. With `keeps_motion` (only parameters have changed) it
/// continues from the present shape and velocities. @return false when the recording lacks the scene.
bool ThreadPlayer::take_scene(const Request& request, bool keeps_motion) {
  const std::size_t next = scene_at(request.tick);
  if (scenes_[next].first_tick <= last_step_ || scenes_[next].first_tick > request.tick) {
    forget("the scene in force from tick " + std::to_string(request.tick) + " on is missing");
    orders_ = request.orders;
    return false;
  }
  current_ = next;
  if (keeps_motion && !thread_) return true;
  auto plant = made(next);
  if (!keeps_motion || plant.continue_from(*thread_)) thread_ = std::move(plant);
  return true;
}

void ThreadPlayer::note_result(std::int64_t tick) {
  const auto& thread = thread_.value();
  result_.tick = tick;
  result_.hand = {thread.hand(physics::Hand::kLeft), thread.hand(physics::Hand::kRight)};
  result_.health = thread.diagnostics();
  result_.add_step({tick, result_.health.cut_at});
  if (const std::int64_t shape = tick / control::kTicksPerShape; shape != std::exchange(shape_of_, shape)) snapshot();
}

void ThreadPlayer::snapshot() {
  control::report(thread_.value(), result_, *shape_);
  shapes_.push_back(telemetry::to_message(*shape_, scenes_[current_].scene.suture.radius_m, 0));
}

/// Writes the thread's fields as PeriodLog does: a lost period repeats the record before it, and a late one has the
/// values of an older tick.
void ThreadPlayer::put_thread(tick_t& tick) {
  rt::TickRecord record;
  if (!is_lost(tick)) {
    control::report(result_.health, record);
    for (std::size_t h = 0; h < rt::kHands; ++h) control::report(result_.hand[h], h, record);
    if (result_.tick != tick.tick)
      record.thread_end = 0, record.thread_cut_at = -1, record.time_lost = 0.0F;
    else if (result_.health.end == physics::TickEnd::kClock)
      record.flags |= rt::kThreadCut;
  }
  const tick_t now = is_lost(tick) ? told_ : telemetry::to_message(record);
  constexpr int kKept = tick_t::FLAG_CONTACT_CAP, kOwn = tick_t::FLAG_THREAD_CUT;
  const int flags = is_lost(tick) ? now.flags & kKept : now.flags & (kKept | kOwn);
  tick.flags = (tick.flags & ~(kKept | kOwn)) | flags;
  for (std::size_t h = 0; h < rt::kHands; ++h) {
    std::ranges::copy(now.f_world_N[h], tick.f_world_N[h]);
    tick.grasped_node[h] = now.grasped_node[h];
    tick.propagation[h] = now.propagation[h];
  }
  tick.kinetic_J = now.kinetic_J, tick.potential_J = now.potential_J, tick.max_stretch = now.max_stretch;
  tick.min_gap_m = now.min_gap_m, tick.contacts = now.contacts, tick.degradation = now.degradation;
  tick.thread_end = now.thread_end, tick.thread_cut_at = now.thread_cut_at, tick.time_lost = now.time_lost;
  for (int i = 0; i < tick.thread_steps; ++i)
    tick.step_cut_at[i] = result_.last_steps[static_cast<std::size_t>(tick.thread_steps - 1 - i)].cut_at;
}

/// Index of the last scene that is in force at that tick.
std::size_t ThreadPlayer::scene_at(std::int64_t tick) const {
  const auto after = std::ranges::upper_bound(scenes_, tick, {}, &PlayedScene::first_tick);
  return after == scenes_.begin() ? 0 : static_cast<std::size_t>(after - scenes_.begin()) - 1;
}

/// Cannot fail: scenes_of() has built each scene before.
physics::Simulation ThreadPlayer::made(std::size_t scene) const {
  return std::get<physics::Simulation>(physics::Simulation::make(scenes_[scene].scene));
}

}  // namespace ligature::lab
