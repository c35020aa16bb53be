#pragma once
// The firmware's real-time side and two simulated hands, joined by CAN frames, on one clock that is a number: faster
// than real time, and the same to the last bit in every run.
//
//   VirtualRig rig({.scene = paper}, script);            // or a SeeingOperator, or any two intentions
//   rig.record("run.lcmlog");                            // what `ligature-host record` would have written
//   if (const auto why = rig.run(23000)) ...             // start-up, ticks, shut-down
//   rig.records, rig.thread, rig.controller ...          // what came of it

#include <array>
#include <exception>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "firmware/cycle.hpp"
#include "firmware/platform/can_master.hpp"
#include "firmware/platform/rig_bus.hpp"
#include "host/lab/rig/device_bus.hpp"
#include "host/lab/rig/recording.hpp"
#include "host/lab/rig/seeing_operator.hpp"
#include "host/lab/rig/true_tip.hpp"
#include "host/lab/rig/virtual_thread.hpp"
#include "protocol/scene/gripper_script.hpp"
#include "protocol/scene/scene.hpp"

namespace ligature::lab {

struct RigSetup {
  scene::Scene scene;
  device::Device device = device::omni();                                       ///< of both hands
  std::array<sim::Body, 2> body{sim::Body::of(device), sim::Body::of(device)};  ///< devices and hands, left and right
  control::Settings settings{20, true};                                         ///< armed from the start
  double frame_loss = 0.0;           ///< share of process data frames that is lost, 0 .. 1
  std::uint64_t seed = 1;            ///< of the losses
  std::string scene_file = "scene";  ///< how a recording calls the scene,
  std::string scene_toml{};          ///< and its text (scene::recorded_text)
};

/// The script's hands. @throws std::runtime_error when a key pose is out of reach.
[[nodiscard]] std::array<std::unique_ptr<sim::Intention>, 2> scripted_hands(const RigSetup& setup,
                                                                            const scene::GripperScript& script);

class VirtualRig {
 public:
  using Intentions = std::array<std::unique_ptr<sim::Intention>, 2>;

  /// @throws std::runtime_error with one line when the physics refuses the scene or a key pose is out of reach.
  VirtualRig(RigSetup setup, const scene::GripperScript& script);
  /// @param seeing must outlive the rig.
  VirtualRig(RigSetup setup, SeeingOperator& seeing);
  VirtualRig(RigSetup setup, Intentions intentions);
  VirtualRig(const VirtualRig&) = delete;
  VirtualRig& operator=(const VirtualRig&) = delete;

  /// Writes an LCM log of everything from here on. @throws when the file exists or cannot be made.
  void record(const std::string& path);

  /// Another scene or parameter is in force since that tick: for the recording.
  void scene_changed(const scene::Scene& scene, std::string scene_toml, std::int64_t first_tick) {
    if (recording_) recording_->scene_changed(scene, std::move(scene_toml), first_tick);
  }

  /// Start-up, so many ticks (or fewer: `end_when_done` ends with the operator), shut-down, recording closed.
  /// @return why it did not start, or nothing. @throws host::RunFailed when the recording could not be written.
  std::optional<std::string> run(std::int64_t ticks, bool end_when_done = false);

  [[nodiscard]] bool is_done() const noexcept;  ///< both operators' hands have let go

  struct Wait final : platform::BusWait {
    explicit Wait(VirtualRig& r) : rig(r) {}
    Nanoseconds now() noexcept override { return rig.time; }
    bool wait(Nanoseconds deadline) noexcept override;
    VirtualRig& rig;
  };
  struct Clock {
    Nanoseconds now() noexcept {
      rig.physics.advance();
      return rig.time;
    }
    void sleep_until(Nanoseconds at) noexcept { rig.sleep_until(at); }
    Nanoseconds worked() noexcept { return Nanoseconds::zero(); }  // work takes no simulated time
    VirtualRig& rig;
  };

  const RigSetup setup;

 private:
  std::array<sim::HeldIntention*, 2> held_{};  // of a seeing operator; before the devices, which own them

 public:
  Nanoseconds time{0};
  std::vector<bool> drives_push;  ///< a motor has torque, at the end of the period before each SYNC
  std::array<TruthWatch, 2> truth{TruthWatch(setup.device), TruthWatch(setup.device)};  ///< as often as drives_push
  std::int64_t cut_left_at = -1;  ///< tick at which the left hand's process dies
  std::int64_t stall_at = 0;      ///< tick at which the real-time thread sleeps too long, once
  Nanoseconds stall_for{0};
  std::function<void()> each_tick;  ///< called between two ticks, the devices just before the next SYNC

  physics::Simulation thread;
  DeviceBus left, right;
  Wait wait{*this};
  platform::RigBus bus{left, right, wait, setup.device};
  Clock clock{*this};
  control::Controller controller;
  std::unique_ptr<rt::Outlets> outlets = std::make_unique<rt::Outlets>();
  std::unique_ptr<control::ThreadExchange> exchange = std::make_unique<control::ThreadExchange>();
  VirtualThread physics{time, thread, *exchange, outlets->shape};
  Cycle<platform::RigBus, Clock, VirtualThread> cycle{bus, clock, controller, *exchange, physics, *outlets};
  std::vector<rt::TickRecord> records;

 private:
  void sleep_until(Nanoseconds at) noexcept;
  void take_records() noexcept;
  void look_and_act();
  void look_at_drives();

  SeeingOperator* seeing_ = nullptr;
  std::unique_ptr<Recording> recording_;
  std::exception_ptr unwritten_;
  bool end_when_done_ = false;
};

}  // namespace ligature::lab
