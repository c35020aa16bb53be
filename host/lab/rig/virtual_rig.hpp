#pragma once
// The firmware's real-time part and two simulated hands, connected by CAN frames, on a simulated clock: faster than
// real time, and bit-identical in every run.
//
//    VirtualRig rig({.scene = paper}, script);            // or a SeeingOperator, or any two intentions
//    rig.record("run.lcmlog");                            // what `ligature-host record` would have written
//    if (const auto why = rig.run(23000)) ...             // start-up, ticks, shut-down
//    rig.records, rig.thread, rig.controller ...          // results

#include <array>
#include <exception>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "firmware/cycle.hpp"
#include "firmware/platform/make_drives.hpp"
#include "firmware/platform/rig_bus.hpp"
#include "host/lab/rig/device_bus.hpp"
#include "host/lab/rig/rig_log.hpp"
#include "host/lab/rig/seeing_operator.hpp"
#include "host/lab/rig/true_tip.hpp"
#include "host/lab/rig/virtual_thread.hpp"
#include "protocol/scene/gripper_script.hpp"
#include "protocol/scene/scene.hpp"

namespace ligature::lab {

struct RigSetup {
  scene::Scene scene;
  device::Device device = device::omni();  ///< device record, for both hands
  /// simulated devices and hands, left and right
  std::array<sim::Body, 2> body{sim::Body::of(device), sim::Body::of(device)};
  control::Settings settings{20, true};  ///< watchdog of 20 ticks, armed from the start
  double frame_loss = 0.0;               ///< fraction of the process data frames (PDOs) that are lost, 0 .. 1
  std::uint64_t seed = 1;                ///< seed of the random frame losses
  std::string scene_file = "scene";      ///< name of the scene in a recording
  std::string scene_toml{};              ///< text of the scene in a recording (scene::recorded_text)
};

/// Two hands that play the script. @throws std::runtime_error when a key pose is out of reach.
[[nodiscard]] std::array<std::unique_ptr<sim::Intention>, 2> scripted_hands(const RigSetup& setup,
                                                                            const scene::GripperScript& script);

class VirtualRig {
 public:
  using Intentions = std::array<std::unique_ptr<sim::Intention>, 2>;

  /// @throws std::runtime_error with one line when the physics refuses the scene or a key pose is out of reach.
  VirtualRig(const RigSetup& setup, const scene::GripperScript& script);
  /// @param seeing must outlive the rig.
  VirtualRig(const RigSetup& setup, SeeingOperator& seeing);
  VirtualRig(RigSetup setup, Intentions intentions);
  VirtualRig(const VirtualRig&) = delete;
  VirtualRig& operator=(const VirtualRig&) = delete;

  /// Writes an LCM log from now on. @throws host::BadInput when the file exists or cannot be created.
  void record(const std::string& path);

  /// Notes in the recording that another scene or other parameters are in force from tick `first_tick` on.
  void scene_changed(const scene::Scene& scene, std::string scene_toml, std::int64_t first_tick) {
    if (recording_) recording_->scene_changed(scene, std::move(scene_toml), first_tick);
  }

  /// Start-up, at most `ticks` ticks, shut-down; closes the recording. With `end_when_done` the run ends when the
  /// operator is done.
  /// @return the reason when it did not start, else nothing. @throws host::RunFailed when the recording could not be
  /// written; validate::Interrupted, with the recording incomplete, when validate::stop_asked said so.
  std::optional<std::string> run(std::int64_t ticks, bool end_when_done = false);

  [[nodiscard]] bool is_done() const noexcept;  ///< whether both hands' motion is over and their dead-men released

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

  static constexpr int kWatchdog_ms = 20;  ///< of the drives

  const RigSetup setup;

 private:
  // the hands of a seeing operator; declared before the devices, which own them
  std::array<sim::HeldIntention*, 2> held_{};

 public:
  Nanoseconds time{0};
  std::vector<bool> drives_push;  ///< per tick: whether a motor had torque at the end of the period before the SYNC
  /// true motion and force at each hand's tip, one entry per tick
  std::array<TruthWatch, 2> truth{TruthWatch(setup.device), TruthWatch(setup.device)};
  std::int64_t cut_left_at = -1;  ///< tick at which the left hand's process is killed; -1: never
  std::int64_t stall_at = 0;      ///< tick at which the real-time loop is delayed once by stall_for
  Nanoseconds stall_for{0};
  /// called between two ticks, with the devices at the time just before the next SYNC
  std::function<void()> each_tick;

  physics::Simulation thread;
  DeviceBus left, right;
  Wait wait{*this};
  std::array<std::unique_ptr<platform::HandDrives>, 2> drives{
      platform::make_drives(left, setup.device, kWatchdog_ms, 0),
      platform::make_drives(right, setup.device, kWatchdog_ms, 1)};
  platform::RigBus bus{*drives[0], *drives[1], wait};
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
  std::unique_ptr<RigLog> recording_;
  std::exception_ptr unwritten_;
  bool end_when_done_ = false, interrupted_ = false;
};

}  // namespace ligature::lab
