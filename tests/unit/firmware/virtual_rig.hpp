#pragma once
// A rig in virtual time: drives that follow commands at once, and a clock that advances only by work and sleep.

#include <deque>
#include <functional>
#include <map>
#include <vector>

#include "firmware/cycle.hpp"
#include "firmware/platform/cia402_time.hpp"
#include "host/lab/rig/virtual_thread.hpp"

namespace ligature {

class VirtualClock {
 public:
  Nanoseconds now() noexcept {
    if (thread != nullptr) thread->advance();  // the physics, which shares this clock, computes up to the current time
    return time;
  }
  void sleep_until(Nanoseconds at) noexcept {
    time = std::max(time, at) + late_by;
    late_by = Nanoseconds::zero();
    woken.push_back(time);
  }
  Nanoseconds worked() noexcept { return work; }
  Nanoseconds time{0}, work{0};
  Nanoseconds late_by{0};  // delay of the next wake-up; later ones are in time
  std::vector<Nanoseconds> woken;
  lab::VirtualThread* thread = nullptr;
};

inline constexpr control::JointAngles kRestingArm{0.0, 0.5, 0.6};

/// Drives that are operational at once. As on the wire, a torque written in a period acts from the next SYNC on.
class VirtualBus {
 public:
  explicit VirtualBus(VirtualClock& clock) : clock_(clock) {
    for (auto& r : reading.hand) {
      r.q_rad = kRestingArm;
      r.valid = r.enabled = true;
    }
  }
  void request() noexcept {
    acting = written;
    ++syncs;
    if (on_sync) on_sync(syncs);
  }
  rt::RigReading read(Nanoseconds) noexcept {
    clock_.time += std::chrono::microseconds(460);
    if (const auto it = stalls.find(syncs); it != stalls.end()) clock_.time += it->second;
    sampled_at.push_back(clock_.time);
    const double moved_rad = waist_rad_per_s * std::chrono::duration<double>(clock_.time).count();
    for (auto& hand : reading.hand) {
      hand.q_rad[0] = kRestingArm[0] + moved_rad;
      hand.dead_man = syncs > control::DeadMan::kReleased;  // a press before that would not count
    }
    return reading;
  }
  rt::WireTorque write(const rt::RigCommand& command) noexcept {
    written = command;
    if (const auto it = works.find(syncs); it != works.end()) clock_.time += it->second, clock_.work += it->second;
    rt::WireTorque wire{};
    for (std::size_t h = 0; h < rt::kHands; ++h) {
      for (std::size_t j = 0; j < rt::kJoints; ++j) {
        wire[h][j] = static_cast<std::int16_t>(command.hand[h].torque_Nm[j] * 1e4);
      }
    }
    return wire;
  }

  [[nodiscard]] rt::BusTime bus_time() const noexcept { return platform::cia402_time(); }

  rt::RigReading reading;
  rt::RigCommand written, acting;
  std::int64_t syncs = 0;
  std::map<std::int64_t, Nanoseconds> stalls;  // extra duration of the tick of the n-th SYNC (from 1), spent waiting
  std::map<std::int64_t, Nanoseconds> works;   // the same, spent computing
  // called with the SYNC's number; its changes take effect in the next period
  std::function<void(std::int64_t)> on_sync;
  std::vector<Nanoseconds> sampled_at;
  double waist_rad_per_s = 0.0;  // speed of both hands' waist joints, also during a stall; the drives sample after it

 private:
  VirtualClock& clock_;
};

inline scene::Scene small_scene() {
  scene::Scene s;
  s.suture.nodes = 10;
  s.suture.length_m = 1.0;
  s.suture.radius_m = 0.01;
  s.world.fixed = {{0, {0.0, 0.0, 5.5}, std::nullopt}};
  s.world.grippers_collide = false;
  s.hands.workspace_scale = 20.0;
  s.hands.energy_credit_J = 0.02;  // these hands never move, so they earn no energy credit
  const control::Linkage arm(device::omni());
  const control::Vec3 tip_W = 20.0 * (arm.position(kRestingArm) - arm.home_m());
  s.hands.workspace_origin_m = {0.02 - tip_W.x(), -tip_W.y(), 4.8 - tip_W.z()};  // both tools 2 cm beside the thread
  return s;
}

/// All parts of a cycle, and access to its records.
struct VirtualRig {
  explicit VirtualRig(const scene::Scene& scene = small_scene(), control::Settings settings = {20, true})
      : thread(std::get<physics::Simulation>(physics::Simulation::make(scene))), controller(scene.hands, settings) {
    clock.thread = &physics;
  }

  std::vector<rt::TickRecord> records() {
    std::vector<rt::TickRecord> all;
    for (rt::TickRecord r; outlets->records.pop(r);) all.push_back(r);
    return all;
  }

  VirtualClock clock;
  VirtualBus bus{clock};
  physics::Simulation thread;
  control::Controller controller;
  std::unique_ptr<rt::Outlets> outlets = std::make_unique<rt::Outlets>();
  std::unique_ptr<control::ThreadExchange> exchange = std::make_unique<control::ThreadExchange>();
  lab::VirtualThread physics{clock.time, thread, *exchange, outlets->shape};
  Cycle<VirtualBus, VirtualClock, lab::VirtualThread> cycle{bus, clock, controller, *exchange, physics, *outlets};
};

}  // namespace ligature
