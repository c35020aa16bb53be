#pragma once
// The thread models of the 2007 paper, with the interface of simulation.hpp: built from a scene, moved by two tools.

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "firmware/physics/members.hpp"
#include "firmware/physics/paper/contact.hpp"
#include "firmware/physics/paper/grasp.hpp"
#include "firmware/physics/paper/internal_step.hpp"
#include "firmware/physics/paper/obstacles.hpp"
#include "firmware/physics/paper/paper_contact.hpp"
#include "firmware/physics/paper/propagation.hpp"
#include "firmware/physics/paper/thread.hpp"
#include "firmware/physics/simulation.hpp"
#include "protocol/scene/scene.hpp"

namespace ligature::physics {

/// Models paper-1 .. paper-5. Same contract as Simulation.
class PaperSimulation {
 public:
  static std::variant<PaperSimulation, std::string> make(const scene::Scene& scene);

  /// Freezes the thread, as after a divergence: it keeps its state, and the hands are open and without force.
  void stop(int bad_node) noexcept;
  void tick(const std::array<ToolInput, 2>& tools, const TimeLeft& left = {}) noexcept;
  [[nodiscard]] std::span<const Vec3> nodes_W() const noexcept { return unpacked(state_.p, nodes_W_, nodes_stale_); }
  [[nodiscard]] std::span<const Vec3> velocities_W() const noexcept {
    return unpacked(state_.v, velocities_W_, velocities_stale_);
  }
  void describe(std::span<float> tension_N, std::span<float> turn_rad) const noexcept;
  std::size_t contacts(std::span<ContactPoint> out) const noexcept;
  [[nodiscard]] const HandContact& hand(Hand h) const noexcept { return hands_[static_cast<std::size_t>(h)]; }
  [[nodiscard]] const Diagnostics& diagnostics() const noexcept { return health_; }
  void reset() noexcept;
  [[nodiscard]] bool continue_from(const PaperSimulation& other) noexcept;
  void set_state(std::span<const Vec3> p_W, std::span<const Vec3> v_W) noexcept;
  /// The members that an image saves (image.hpp). Not saved: the pointer to the step's function, the clock, and the
  /// nodes as vectors, which are converted again when somebody asks for them.
  [[nodiscard]] static auto members(PaperSimulation& self) noexcept {
    auto& [model, kind, swivel, initial, state, before, work, internal, forward, explicit_damping, has_limits,
           contact_kind, contact, paper_contact, course, limits, coupling, grasp, gravity, loads, substeps, time,
           tick_s, ticks, kinetic_J, weight_J, rate_v, hands, health, nodes, velocities, nodes_stale,
           velocities_stale] = self;
    return std::tie(model, kind, swivel, initial, state, before, work, forward, explicit_damping, has_limits,
                    contact_kind, contact, paper_contact, course, limits, coupling, grasp, gravity, loads, substeps,
                    tick_s, ticks, kinetic_J, weight_J, rate_v, hands, health);
  }
  /// Call after the members were loaded from an image.
  void loaded() noexcept { nodes_stale_ = velocities_stale_ = true; }

 private:
  PaperSimulation() = default;
  void set_contact(const scene::Scene& scene);
  [[nodiscard]] std::array<V3<double>, 2> hand_forces_N(const std::array<ToolInput, 2>& tools) noexcept;
  void add_external(const std::array<ToolInput, 2>& tools) noexcept;
  [[nodiscard]] double integrate(const Lane3& v_W) noexcept;
  void step(const std::array<ToolInput, 2>& tools) noexcept;
  void feel_what_was_done(int substeps, const std::array<Vec3, 2>& before) noexcept;
  [[nodiscard]] double fastest() const noexcept;
  [[nodiscard]] Propagation condition(int node, bool other_holds) const noexcept;
  void remember() noexcept;
  [[nodiscard]] bool check() noexcept;
  void publish() noexcept;
  void publish_contacts() noexcept;
  void restart() noexcept;
  static std::span<const Vec3> unpacked(const Lane3& from, std::vector<Vec3>& to, bool& stale) noexcept;

  ThreadModel model_;
  scene::Model kind_ = scene::Model::kPaper4;  // kind_ and swivel_ choose internal_, which no image has
  scene::SwivelDamper swivel_ = scene::SwivelDamper::kInternal;
  ThreadState initial_, state_, before_;  // before_: state at the start of the tick
  InternalWorkspace work_;
  InternalStep internal_ = nullptr;
  bool forward_ = false, explicit_damping_ = false, has_limits_ = false;
  scene::ContactSolver contact_kind_ = scene::ContactSolver::kNone;
  ContactSolver contact_;       // the implicit solver
  PaperContact paper_contact_;  // the paper's own solver, for comparison
  ObstacleCourse course_;       // grippers and the frame's hooks
  LengthLimits limits_;
  Coupling coupling_;
  Grasp grasp_;
  V3<double> gravity_{};
  std::vector<std::pair<int, V3<double>>> loads_;
  int substeps_ = 1;
  TickTime time_;
  double tick_s_ = 1e-3;
  std::int64_t ticks_ = 0;
  double kinetic_J_ = 0.0, weight_J_ = 0.0;
  Lane3 rate_v_;
  std::array<HandContact, 2> hands_{};
  Diagnostics health_{};
  mutable std::vector<Vec3> nodes_W_, velocities_W_;  // converted on demand, as most ticks do not need them
  mutable bool nodes_stale_ = true, velocities_stale_ = true;
};

}  // namespace ligature::physics
