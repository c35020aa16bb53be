#include "firmware/app/real_time_side.hpp"

#include <spdlog/spdlog.h>

#include <cmath>

namespace ligature::app {

RealTimeSide::RealTimeSide(const RunOptions& options, Plan& plan, const Buses& buses, rt::Outlets& outlets,
                           control::PlantHandover& plants)
    : buses_(buses),
      wait_(*buses.left, *buses.right),
      bus_(*buses.drives[0], *buses.drives[1], wait_),
      controller_(plan.scene.hands, {options.watchdog_ms, options.arm, plan.device}),
      cycle_(bus_, clock_, controller_, exchange_, wake_physics_, outlets),
      physics_(clock_, plan.thread, exchange_, outlets.shape),
      physics_core_(options.physics_core) {
  cycle_.listen(plants);
  if (options.duration_s) cycle_.end_after(std::llround(*options.duration_s / control::kPeriod_s));
}

platform::Refusals RealTimeSide::prepare(bool ask, int core) {
  platform::Refusals refused = ask ? platform::lock_memory() : platform::Refusals{};
  if (ask) stay_awake();
  thread_ = std::thread([this, ask, core] {
    platform::flush_denormals();
    rights_.set_value(ask ? platform::make_realtime(core) : platform::Refusals{});
    if (go_.get_future().get()) {
      cycle_.run();
      release();
    }
    beating_ = false;
  });
  for (const auto& r : rights_.get_future().get()) refused.push_back(r);
  physics_thread_ = std::thread(&RealTimeSide::run_physics, this, ask, physics_core_ >= 0 ? physics_core_ : core);
  for (const auto& r : physics_rights_.get_future().get()) refused.push_back(r + " (the thread's physics)");
  for (const auto& r : refused) spdlog::warn("real time: {}", r);
  return refused;
}

void RealTimeSide::run_physics(bool ask, int core) {
  platform::flush_denormals();
  physics_rights_.set_value(ask ? platform::make_realtime(core, platform::kPhysicsPriority) : platform::Refusals{});
  physics_.run(wake_physics_);
}

void RealTimeSide::start() {
  started_ = true;
  go_.set_value(true);
}

void RealTimeSide::end() {
  if (!thread_.joinable()) return;
  if (!started_) go_.set_value(false);
  thread_.join();
  wake_physics_.end();
  physics_thread_.join();
}

/// Keeps the CPU out of deep idle states. If the kernel refuses, this is only logged, even with --rt=enforce: wake-ups
/// then come later, which doctor and the tick records show.
void RealTimeSide::stay_awake() {
  awake_.emplace();
  if (!awake_->refusal().empty()) spdlog::warn("real time: {}", awake_->refusal());
}

/// Switches the drives off at once, instead of leaving that to their watchdogs. Each hand has a wait of its own, on its
/// bus only, so that unread frames of the other bus cannot end the wait.
void RealTimeSide::release() {
  constexpr std::array kNames{"left", "right"};
  const std::array bus{buses_.left.get(), buses_.right.get()};
  for (std::size_t h = 0; h < rt::kHands; ++h) {
    platform::PollWait alone(*bus[h], *bus[h]);
    if (const auto still_on = buses_.drives[h]->release(alone)) spdlog::error("{} hand: {}", kNames[h], *still_on);
  }
}

}  // namespace ligature::app
