#pragma once
// The whole rig in virtual time with the drives of a device record, on buses that take the time of each bit.

#include <algorithm>
#include <array>
#include <memory>
#include <string>
#include <utility>
#include <variant>

#include "host/lab/rig/virtual_rig.hpp"
#include "protocol/device/device_file.hpp"
#include "tests/integration/virtual_rig/scenes.hpp"

namespace ligature {

using lab::DeviceBus;

/// A hand that releases the dead-man when it is told so.
class LettingGo final : public sim::Intention {
 public:
  LettingGo(std::unique_ptr<sim::Intention> hand, const bool& lets_go) : hand_(std::move(hand)), lets_go_(lets_go) {}
  [[nodiscard]] sim::Intent at(double t_s, const sim::Touch& touch) const noexcept override {
    sim::Intent intent = hand_->at(t_s, touch);
    intent.dead_man = intent.dead_man && !lets_go_;
    return intent;
  }
  [[nodiscard]] double end_s() const noexcept override { return hand_->end_s(); }
  [[nodiscard]] sim::Vec3 start_D_m() const noexcept override { return hand_->start_D_m(); }

 private:
  std::unique_ptr<sim::Intention> hand_;
  const bool& lets_go_;
};

struct DeadMen {
  std::array<bool, 2> lets_go{};  ///< left, right
};

struct ShelfRig : DeadMen, lab::VirtualRig {
  explicit ShelfRig(const std::string& record) : ShelfRig(record, device_of(record), overhand()) {}
  /// @param device  the record, perhaps with changes
  ShelfRig(const std::string& record, const device::Device& device, const scene::GripperScript& script)
      : ShelfRig(lab::RigSetup{.scene = scene_of(record), .device = device}, script) {}

  /// The paper's scene. Only the Inverse3 does not reach all of it as it is shipped: docs/bridge.md has these two
  /// values.
  static scene::Scene scene_of(const std::string& record) {
    scene::Scene scene = paper();
    if (record != "inverse3.toml") return scene;
    scene.hands.workspace_scale = 30.0;
    scene.hands.workspace_origin_m = {0.5, -0.4, 3.3};
    return scene;
  }
  static device::Device device_of(const std::string& record) {
    return std::get<device::Device>(device::load_device(kScenes + "devices/" + record));
  }

  static scene::GripperScript overhand() {
    return std::get<scene::GripperScript>(scene::load_gripper_script(kScenes + "operators/overhand.csv"));
  }

  std::array<DeviceBus*, 2> buses() { return {&left, &right}; }
  static bool has_torque(const DeviceBus& b) {
    return std::ranges::any_of(b.device.drives(), [](const auto& drive) { return drive->torque_Nm() != 0.0; });
  }
  bool has_torque() const { return has_torque(left) || has_torque(right); }
  std::int64_t trips() {
    std::int64_t sum = 0;
    for (const DeviceBus* b : buses())
      for (const auto& drive : b->device.drives()) sum += drive->stats().watchdog_trips;
    return sum;
  }

 private:
  ShelfRig(const lab::RigSetup& with, const scene::GripperScript& script)
      : VirtualRig(with, hands(with, script, lets_go)) {}

  static Intentions hands(const lab::RigSetup& with, const scene::GripperScript& script,
                          const std::array<bool, 2>& lets_go) {
    Intentions hands = lab::scripted_hands(with, script);
    for (std::size_t h = 0; h < hands.size(); ++h)
      hands[h] = std::make_unique<LettingGo>(std::move(hands[h]), lets_go[h]);
    return hands;
  }
};

}  // namespace ligature
