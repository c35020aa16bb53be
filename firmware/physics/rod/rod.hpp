#pragma once
// A rod in its world: the parts together, and the list of verbs that is a tick.

#include <cstdint>
#include <span>
#include <vector>

#include "firmware/physics/rod/assembly.hpp"
#include "firmware/physics/rod/contact.hpp"
#include "firmware/physics/rod/refine.hpp"
#include "firmware/physics/rod/twist.hpp"

namespace ligature::physics::rod {

/// What a scene models. Each combination is its own compiled substep; what is absent is not executed.
struct Parts {
  bool twist = true;
  bool contact = true;  ///< of the thread with itself
  bool friction = true;
  bool world = false;     ///< floor and bodies
  bool adaptive = false;  ///< nodes move along the thread to where they are needed
};

/// What a tick did. Plain values.
struct TickReport {
  int substeps = 0, passes = 0, contacts = 0, guard_events = 0, broad_phases = 0, remeshes = 0;
  double min_gap_m = 1e9;  ///< smallest thread-thread gap in any substep; negative: overlap
  bool cap_hit = false;
  int cut_short = 0;  ///< substeps whose contacts used up their passes before they settled: what was degraded
};

/// A rod. Build it, place it with state(), then tick. Only the constructor allocates. Copyable.
class Rod {
 public:
  /// @param n nodes, >= 3, equally spaced to begin with; straight along +x from the origin, at rest.
  Rod(const Material& material, const Numerics& numerics, const Parts& parts, int n, int bodies = 0);

  Rod(const Rod& other);
  Rod& operator=(const Rod& other);
  Rod(Rod&&) noexcept = default;
  Rod& operator=(Rod&&) noexcept = default;
  ~Rod() = default;

  Vec gravity{};
  double floor_m = 0.0, floor_friction = 0.3;
  bool has_floor = false;
  std::vector<Body> bodies;

  [[nodiscard]] State& state() noexcept { return state_; }
  [[nodiscard]] const State& state() const noexcept { return state_; }
  [[nodiscard]] const Material& material() const noexcept { return material_; }
  [[nodiscard]] Numerics& numerics() noexcept { return numerics_; }
  [[nodiscard]] Twist& twist() noexcept { return twist_; }
  [[nodiscard]] const Twist& twist() const noexcept { return twist_; }
  [[nodiscard]] const Forces& forces() const noexcept { return forces_; }
  [[nodiscard]] const ContactSet& contact_set() const noexcept { return contacts_; }

  /// Where nodes move: lays them out anew for a thread curved so at places equally far apart along it. For a rod that
  /// has not moved yet; positions are the caller's, from state().mesh.s.
  void spread(std::span<const double> curvature_per_m);

  /// After positions, clamps or spacing were changed from outside: constants of the mesh again, contacts forgotten.
  void moved() noexcept;

  /// The motion, holds and twist of another rod, with this one's material. @return false, and nothing done, when it has
  /// another number of nodes. No allocation.
  [[nodiscard]] bool continue_from(const Rod& other) noexcept;

  /// Holds node: @return index of the hold. @pre fewer than kMaxHolds.
  int support(int node, Vec p) noexcept;
  int clamp(int node, Vec p, Vec direction) noexcept;
  int grip(int node, double stiffness_N_per_m, double damping_N_s_per_m, Vec tool, bool holds_roll = true) noexcept;
  void release(int hold) noexcept;

  /// Advances by numerics().tick_s. `goals` are the hold targets at the end of the tick (unmoved holds: their target).
  void tick(const std::array<Vec, kMaxHolds>& goals) noexcept;
  void tick() noexcept;

  /// The first verb of a tick, on its own: nodes move along the thread. @return true when some did.
  bool remesh() noexcept;
  /// Keeps tick() from moving nodes along the thread, until told otherwise. For those who call remesh() themselves.
  void hold_mesh(bool on) noexcept { mesh_held_ = on; }

  [[nodiscard]] const TickReport& report() const noexcept { return report_; }
  [[nodiscard]] Energy energy() const noexcept { return rod::energy(material_, state_, gravity); }

 private:
  using Substep = void (Rod::*)(double) noexcept;
  template <unsigned Bits>
  void substep(double dt_s) noexcept;
  static Substep pick(const Parts& parts) noexcept;
  template <unsigned Bits>
  ContactReport collect(double dt_s, double near_m, double look_m) noexcept;
  template <unsigned Bits>
  double guard(double dt_s, double near_m) noexcept;
  void broad_phase() noexcept;
  [[nodiscard]] int passes_allowed() const noexcept;
  int add_hold(const Hold& hold) noexcept;

  Material material_;
  Numerics numerics_;
  Parts parts_;
  State state_;
  Forces forces_;
  BandSolver solver_;
  ContactMetric metric_;
  ContactSet contacts_;
  BroadPhase broad_;
  Twist twist_;
  Refine refine_;
  TickReport report_;
  Substep substep_;
  double metric_dt_ = 0.0, settled_m_per_s_ = 0.0;
  Motion motion_;
  double horizon_s_ = 0.0;      // how far the list of pairs looks ahead
  double tick_travel_m_ = 0.0;  // what the fastest node may have gone since the tick began
  int substep_index_ = 0;
  bool mesh_held_ = false;
  bool released_ = false;  // a hold let go since the last tick
  bool stale_ = true;      // the list must be made again
};

}  // namespace ligature::physics::rod
