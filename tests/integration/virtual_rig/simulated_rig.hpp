#pragma once
// The firmware's real-time side and two simulated hands, joined by CAN frames, on one clock that is a number.

#include <vector>

#include "firmware/cycle.hpp"
#include "firmware/platform/can_master.hpp"
#include "firmware/platform/rig_bus.hpp"
#include "protocol/scene/gripper_script.hpp"
#include "protocol/scene/scene_file.hpp"
#include "sim_device/fault_injector.hpp"
#include "sim_device/hand_device.hpp"

namespace ligature {

/// The cable between a simulated hand and the firmware. Frames come when their last bit has passed.
class DeviceBus final : public platform::CanBus {
 public:
  DeviceBus(sim::OperatorPath path, const Nanoseconds& now) : device(std::move(path), now), now_(now) {}

  bool send(const can::Frame& frame) noexcept override {
    if (!cut) device.submit(frame, sim::HandDevice::kFirstClient, now_);
    return !cut;
  }
  platform::Receive receive(can::Frame& frame) noexcept override {
    if (cut) return platform::Receive::kLost;
    device.advance(now_);
    if (faults) faults->apply(device, now_);
    auto& out = device.deliveries();
    while (!out.empty() && out.front().due <= now_) {
      const sim::Delivery first = out.front();
      out.erase(out.begin());
      if (first.sender == sim::HandDevice::kFirstClient) continue;  // nobody hears itself
      frame = first.frame;
      return platform::Receive::kFrame;
    }
    return platform::Receive::kNothing;
  }
  [[nodiscard]] bool is_lost() const noexcept override { return cut; }
  [[nodiscard]] int descriptor() const noexcept override { return -1; }

  sim::HandDevice device;
  std::optional<sim::FaultInjector> faults;
  bool cut = false;  // the hand's process was killed

 private:
  const Nanoseconds& now_;
};

struct SimulatedRig {
  SimulatedRig(const scene::Scene& scene, const scene::GripperScript& script)
      : thread(std::get<physics::Simulation>(physics::Simulation::make(scene))),
        left(path(scene, script, 0), time),
        right(path(scene, script, 1), time),
        controller(scene.hands, {20, true}) {}

  static sim::OperatorPath path(const scene::Scene& scene, const scene::GripperScript& script, std::size_t hand) {
    return std::get<sim::OperatorPath>(sim::OperatorPath::make(script.keys[hand], sim::WorkspaceMap(scene.hands)));
  }

  struct Wait final : platform::BusWait {
    explicit Wait(SimulatedRig& r) : rig(r) {}
    Nanoseconds now() noexcept override { return rig.time; }
    bool wait(Nanoseconds deadline) noexcept override {
      if (rig.time >= deadline) return false;
      rig.time = std::min(deadline, rig.time + std::chrono::microseconds(20));
      return true;
    }
    SimulatedRig& rig;
  };

  struct RigClock {
    Nanoseconds now() noexcept { return rig.time; }
    void sleep_until(Nanoseconds at) noexcept {
      for (rt::TickRecord r; rig.outlets->records.pop(r);) rig.records.push_back(r);
      if (rig.cut_left_at >= 0 && static_cast<std::int64_t>(rig.records.size()) >= rig.cut_left_at) rig.left.cut = true;
      rig.time = std::max(rig.time, at);
      for (DeviceBus* bus : {&rig.left, &rig.right}) bus->device.advance(at);
      rig.look_at_drives();
      if (static_cast<std::int64_t>(rig.records.size()) < rig.stall_at) return;
      for (; rig.stall_for > Nanoseconds(0); rig.stall_for -= kPeriod) {
        rig.time += kPeriod;
        for (DeviceBus* bus : {&rig.left, &rig.right}) bus->device.advance(rig.time);
        rig.look_at_drives();
      }
    }
    static constexpr Nanoseconds kPeriod = std::chrono::milliseconds(1);
    SimulatedRig& rig;
  };

  /// Start-up, so many ticks, shut-down. @return why it did not start, or nothing.
  std::optional<std::string> run(std::int64_t ticks) {
    for (DeviceBus* b : {&left, &right}) {
      if (auto why = platform::configure_drives(*b, wait, {})) return why;
    }
    platform::start_drives(left);
    platform::start_drives(right);
    cycle.end_after(ticks);
    cycle.run();
    for (rt::TickRecord r; outlets->records.pop(r);) records.push_back(r);
    return std::nullopt;
  }

  void look_at_drives() {
    const auto on = [](const DeviceBus& b) {
      return std::ranges::any_of(b.device.torque_permille(), [](auto t) { return t != 0; });
    };
    drives_push.push_back(on(left) || on(right));
  }

  Nanoseconds time{0};
  std::vector<bool> drives_push;  // a motor has torque, at the end of the period before each SYNC
  std::int64_t cut_left_at = -1;  // tick at which the left hand's process dies
  std::int64_t stall_at = 0;      // tick at which the real-time thread sleeps too long, once
  Nanoseconds stall_for{0};
  physics::Simulation thread;
  DeviceBus left, right;
  Wait wait{*this};
  platform::RigBus bus{left, right, wait};
  RigClock clock{*this};
  control::Controller controller;
  std::unique_ptr<rt::Outlets> outlets = std::make_unique<rt::Outlets>();
  Cycle<platform::RigBus, RigClock> cycle{bus, clock, controller, thread, *outlets};
  std::vector<rt::TickRecord> records;
};

}  // namespace ligature
