#include "host/lab/rig/virtual_rig.hpp"

#include <algorithm>
#include <cfenv>
#include <stdexcept>

#include "firmware/platform/realtime.hpp"
#include "host/lab/validate/proceed.hpp"
#include "sim_device/script_hand.hpp"

namespace ligature::lab {
namespace {

using rt::kPeriod;
constexpr Nanoseconds kGlance = std::chrono::microseconds(20);  // interval at which the buses are polled

control::Settings settings_of(const RigSetup& setup) {
  control::Settings settings = setup.settings;
  settings.device = setup.device;
  return settings;
}

physics::Simulation thread_of(const scene::Scene& scene) {
  auto made = physics::Simulation::make(scene);
  if (const auto* why = std::get_if<std::string>(&made)) throw std::runtime_error(*why);
  return std::get<physics::Simulation>(std::move(made));
}

/// Sets the firmware's floating-point mode (denormals flushed to zero) for its lifetime.
class FlushedDenormals {
 public:
  FlushedDenormals() {
    std::fegetenv(&before_);
    platform::flush_denormals();
  }
  ~FlushedDenormals() { std::fesetenv(&before_); }
  FlushedDenormals(const FlushedDenormals&) = delete;
  FlushedDenormals& operator=(const FlushedDenormals&) = delete;

 private:
  std::fenv_t before_{};
};

VirtualRig::Intentions held(const RigSetup& setup, const SeeingOperator& seeing) {
  VirtualRig::Intentions hands;
  for (std::size_t h = 0; h < 2; ++h) {
    const sim::WorkspaceMap map(setup.scene.hands, setup.body[h].plant.linkage);
    const sim::Vec3 start = map.to_device(seeing.start_W_m()[h]);
    if (!map.linkage.joints(start)) throw std::runtime_error("the operator's hands start out of the devices' reach");
    hands[h] = std::make_unique<sim::HeldIntention>(start);
  }
  return hands;
}

}  // namespace

VirtualRig::Intentions scripted_hands(const RigSetup& setup, const scene::GripperScript& script) {
  VirtualRig::Intentions hands;
  for (std::size_t h = 0; h < 2; ++h) {
    auto hand = sim::script_hand(script, h, sim::WorkspaceMap(setup.scene.hands, setup.body[h].plant.linkage));
    if (const auto* why = std::get_if<std::string>(&hand)) throw std::runtime_error(*why);
    hands[h] = std::get<std::unique_ptr<sim::Intention>>(std::move(hand));
  }
  return hands;
}

VirtualRig::VirtualRig(const RigSetup& s, const scene::GripperScript& script)
    : VirtualRig(s, scripted_hands(s, script)) {}

VirtualRig::VirtualRig(const RigSetup& s, SeeingOperator& seeing) : VirtualRig(s, held(s, seeing)) {
  seeing_ = &seeing;
}

VirtualRig::VirtualRig(RigSetup s, Intentions intentions)
    : setup(std::move(s)),
      thread(thread_of(setup.scene)),
      left((held_[0] = dynamic_cast<sim::HeldIntention*>(intentions[0].get()), std::move(intentions[0])), setup.body[0],
           setup.device, time),
      right((held_[1] = dynamic_cast<sim::HeldIntention*>(intentions[1].get()), std::move(intentions[1])),
            setup.body[1], setup.device, time),
      controller(setup.scene.hands, settings_of(setup)) {
  left.lose_frames(setup.frame_loss, 2 * setup.seed);
  right.lose_frames(setup.frame_loss, 2 * setup.seed + 1);
}

std::optional<std::string> VirtualRig::run(std::int64_t ticks, bool end_when_done) {
  const FlushedDenormals like_the_firmware;
  end_when_done_ = end_when_done;
  for (const auto& hand : drives) {
    if (auto why = hand->configure(wait)) return why;
  }
  for (const auto& hand : drives) hand->start();
  cycle.end_after(ticks);
  cycle.run();
  take_records();
  if (unwritten_) std::rethrow_exception(unwritten_);
  if (interrupted_) throw validate::Interrupted();
  if (recording_) recording_->close();
  return std::nullopt;
}

bool VirtualRig::is_done() const noexcept {
  return left.device.mechanics().is_done() && right.device.mechanics().is_done();
}

bool VirtualRig::Wait::wait(Nanoseconds deadline) noexcept {
  if (rig.time >= deadline) return false;
  rig.time = std::min(deadline, rig.time + kGlance);
  return true;
}

void VirtualRig::sleep_until(Nanoseconds at) noexcept {
  take_records();
  if (validate::stop_asked()) interrupted_ = true, cycle.end_after(0);  // nothing may be thrown here: run() does
  if (cut_left_at >= 0 && cycle.periods() >= cut_left_at) left.cut = true;
  if (seeing_ != nullptr) look_and_act();
  time = std::max(time, at);
  for (DeviceBus* b : {&left, &right}) b->device.advance(at);
  look_at_drives();
  if (each_tick) each_tick();
  if (end_when_done_ && is_done()) cycle.end_after(0);
  if (cycle.periods() < stall_at) return;
  for (; stall_for > Nanoseconds(0); stall_for -= kPeriod) {
    time += kPeriod;
    for (DeviceBus* b : {&left, &right}) b->device.advance(time);
    look_at_drives();
  }
}

/// Called between two ticks, where nothing may be thrown: a failure to write ends the run, and run() rethrows it.
void VirtualRig::take_records() noexcept {
  try {
    for (rt::TickRecord r; outlets->records.pop(r);) {
      records.push_back(r);
      if (recording_) recording_->take(r);
    }
    if (recording_ && outlets->shape.refresh()) recording_->take(outlets->shape.front());
  } catch (...) {
    unwritten_ = std::current_exception();
    recording_.reset();
    cycle.end_after(0);
  }
}

/// Shows the operator what a person would see on the screen and feel, and applies the hand motion that it answers with.
void VirtualRig::look_and_act() {
  const std::array<const sim::Mechanics*, 2> hands{&left.device.mechanics(), &right.device.mechanics()};
  if (!hands[0]->has_started() || !hands[1]->has_started() || cycle.periods() == 0) return;
  const sim::WorkspaceMap map(setup.scene.hands, setup.body[0].plant.linkage);
  sim::Sight sight;
  sight.t_s = std::min(hands[0]->script_time_s(), hands[1]->script_time_s());
  sight.thread_W = thread.nodes_W();
  for (std::size_t h = 0; h < 2; ++h) {
    const auto& f = controller.hand(h).f_device_N;
    sight.tool_W[h] = map.to_world(hands[h]->touch().p_DT);
    sight.holds[h] = thread.hand(static_cast<physics::Hand>(h)).node >= 0;
    if (setup.scene.hands.force_scale > 0.0) sight.force_W_N[h] = sim::Vec3(f / setup.scene.hands.force_scale);
  }
  const auto wishes = seeing_->act(sight);
  for (std::size_t h = 0; h < 2; ++h) {
    const auto& wish = wishes[h];
    held_[h]->set(hands[h]->script_time_s(), {map.to_device(wish.p_W), wish.v_W / map.scale, wish.grip});
    if (seeing_->is_done() && held_[h]->end_s() > hands[h]->script_time_s())
      held_[h]->finish(hands[h]->script_time_s());
  }
}

void VirtualRig::look_at_drives() {
  const auto on = [](const DeviceBus& b) {
    return std::ranges::any_of(b.device.torque_permille(), [](auto t) { return t != 0; });
  };
  drives_push.push_back(on(left) || on(right));
  truth[0].look(left.device);
  truth[1].look(right.device);
}

}  // namespace ligature::lab
