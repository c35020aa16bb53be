#pragma once
// The rod with the interface of firmware/physics/simulation.hpp: built from a scene, moved by two tools.

#include <array>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "firmware/physics/closing.hpp"
#include "firmware/physics/members.hpp"
#include "firmware/physics/rod/grip/jaws.hpp"
#include "firmware/physics/rod/rod.hpp"
#include "firmware/physics/simulation.hpp"
#include "protocol/scene/scene.hpp"

namespace ligature::physics::rod {

/// State of the hands, and the results published last. continue_from() copies this and the state of the rod, nothing
/// else.
struct HandsCourse {
  std::array<Jaws, 2> jaws_;
  std::array<Closing, 2> closing_;
  std::array<bool, 2> closed_{false, false}, inside_{true, true};
  std::array<Vec, kMaxHolds> goals_{};
  std::array<HandContact, 2> hands_{};
  Diagnostics health_{};
  std::int64_t ticks_ = 0;
  std::vector<Vec3> nodes_, velocities_;
  LIGATURE_MEMBERS(HandsCourse, jaws, closing, closed, inside, goals, hands, health, ticks, nodes, velocities)
};

/// The thread, and the scene's settings for the hands.
struct Stage {
  Rod initial_, rod_;
  double reach_m_ = 0.0;
  bool grippers_ = false;
  int gripper_body_ = 0;                  // index of the left gripper's capsule
  std::vector<Vec> x_before_, v_before_;  // scratch of tick()
  /// The members that an image saves (image.hpp). Not saved: initial_, which follows from the scene, and scratch
  /// memory.
  [[nodiscard]] static auto members(Stage& self) noexcept {
    auto& [initial, rod, reach_m, grippers, gripper_body, x_before, v_before] = self;
    return std::tie(rod, reach_m, grippers, gripper_body);
  }
};

/// Same contract as physics::Simulation. With adaptive node spacing, a node's index does not stand for a fixed point of
/// the thread, because nodes move along the thread (refine.hpp); their number is constant.
class RodSimulation : private HandsCourse, private Stage {
 public:
  static std::variant<RodSimulation, std::string> make(const scene::Scene& scene);

  /// Freezes the thread, as after a divergence: it keeps its state, and the hands are open and without force.
  void stop(int bad_node) noexcept;
  void tick(const std::array<ToolInput, 2>& tools, const TimeLeft& left = {}) noexcept;
  [[nodiscard]] std::span<const Vec3> nodes_W() const noexcept { return nodes_; }
  [[nodiscard]] std::span<const Vec3> velocities_W() const noexcept { return velocities_; }
  [[nodiscard]] const HandContact& hand(Hand h) const noexcept { return hands_[static_cast<std::size_t>(h)]; }
  [[nodiscard]] const Diagnostics& diagnostics() const noexcept { return health_; }
  /// Computes for each node the tension of the segment after it, N, and the twist angle between node 0 and this node,
  /// rad. The angle grows along a segment of length ds by M ds / GJ (M: twisting moment of the last tick, GJ: twisting
  /// stiffness). O(n).
  void describe(std::span<float> tension_N, std::span<float> turn_rad) const noexcept;
  /// @see Simulation::contacts
  std::size_t contacts(std::span<ContactPoint> out) const noexcept;
  void set_work(long instructions) noexcept {
    initial_.numerics().given_work = rod_.numerics().given_work = instructions;
  }
  [[nodiscard]] long work() const noexcept { return rod_.numerics().budget(rod_.state().nodes()); }
  void reset() noexcept;
  [[nodiscard]] bool continue_from(const RodSimulation& other) noexcept;
  void set_state(std::span<const Vec3> p_W, std::span<const Vec3> v_W) noexcept;

  [[nodiscard]] static auto members(RodSimulation& self) noexcept {
    return std::tie(static_cast<HandsCourse&>(self), static_cast<Stage&>(self));
  }
  /// Call after the members were loaded from an image.
  void loaded() noexcept { initial_.numerics().given_work = rod_.numerics().given_work; }

  /// The rod itself, for tests and studies.
  [[nodiscard]] const Rod& rod() const noexcept { return rod_; }
  [[nodiscard]] Rod& rod() noexcept { return rod_; }

 private:
  RodSimulation(const scene::Scene& scene, Rod rod);
  void close_jaws(std::size_t hand, const ToolInput& tool, const Mat* R_WT) noexcept;
  void update_grasp(const std::array<ToolInput, 2>& tools) noexcept;
  void update_grippers(const std::array<ToolInput, 2>& tools) noexcept;
  [[nodiscard]] int nearest_free(Vec p) const noexcept;
  void publish() noexcept;
  [[nodiscard]] bool is_finite() noexcept;
};

}  // namespace ligature::physics::rod
