#pragma once
// The rod: a thread's state, material, solvers and contacts, and the tick that advances them.

#include <cstdint>
#include <optional>
#include <span>

#include "firmware/physics/rod/rod_memory.hpp"

namespace ligature::physics::rod {

/// A simulated thread. Construct it, set its shape through state(), then call tick(). Only the constructor and spread()
/// allocate memory, and an assignment from a rod of another size. The data are in three structs, which a copy treats
/// differently (rod_memory.hpp): it copies RodKept, starts with an empty RodNow, and computes RodCache again. Without
/// contact, a copy continues exactly as its original, to the bit. With contact, the list of pairs and the contact
/// matrices are computed again, which changes rounding (Copy.* in copies_test.cpp). They are not copied, because they
/// are large and reset() copies within the real-time loop.
class Rod : private RodKept, private RodNow, private RodCache {
 public:
  /// The thread is straight along +x from the origin, at rest, with equally spaced nodes. With Parts::adaptive the
  /// material coordinates state().mesh.s are not equally spaced: set the positions from them. They stay equally spaced,
  /// as without adaptive, if n is below length / 16 d or above length / d (d: diameter).
  /// @param n  number of nodes, >= 3  @param bodies  the largest number of bodies that will ever be added
  Rod(const Material& material, const Numerics& numerics, const Parts& parts, int n, int bodies = 0);

  Rod(const Rod& other);
  Rod& operator=(const Rod& other);
  Rod(Rod&&) noexcept = default;
  Rod& operator=(Rod&&) noexcept = default;
  ~Rod() = default;

  /// The members that an image saves (image.hpp): all but RodNow, which is reset at the start of every tick.
  [[nodiscard]] static auto members(Rod& self) noexcept {
    return std::tie(static_cast<World&>(self), static_cast<RodCourse&>(self), static_cast<RodMatter&>(self),
                    static_cast<RodCache&>(self));
  }

  using World::bodies, World::floor_friction, World::floor_m, World::gravity, World::has_floor;

  [[nodiscard]] State& state() noexcept { return state_; }
  [[nodiscard]] const State& state() const noexcept { return state_; }
  [[nodiscard]] const Material& material() const noexcept { return material_; }
  [[nodiscard]] Numerics& numerics() noexcept { return numerics_; }
  [[nodiscard]] const Numerics& numerics() const noexcept { return numerics_; }
  [[nodiscard]] Twist& twist() noexcept { return twist_; }
  [[nodiscard]] const Twist& twist() const noexcept { return twist_; }
  [[nodiscard]] const Spin& spin() const noexcept { return spin_; }  ///< used with Parts::frames() only
  [[nodiscard]] double twist_energy_J() const noexcept {
    return parts_.frames() ? spin_.energy_J(material_, state_) : twist_.energy_J();
  }
  [[nodiscard]] const Forces& forces() const noexcept { return forces_; }
  [[nodiscard]] const ContactSet& contact_set() const noexcept { return contacts_; }

  /// With Parts::adaptive: chooses the initial node spacing for a shape with the given curvature, 1/m, sampled at equal
  /// distances along the thread. Call before the first tick, and then set the positions from state().mesh.s.
  void spread(std::span<const double> curvature_per_m);

  /// Call after positions, clamps or spacing were changed from outside: recomputes the mesh constants and forgets the
  /// contacts. With Parts::frames() the thread then starts without twist.
  void moved() noexcept;

  /// Takes over the motion, holds and twist of another rod, but keeps its own material and surroundings. No allocation.
  /// Bends that are permanent, and the roll, are lost if only one of the two has Parts::frames().
  /// @return false if the numbers of nodes or Parts::adaptive differ; then nothing is changed.
  [[nodiscard]] bool continue_from(const Rod& other) noexcept;

  /// Three ways to hold a node. Each returns the index of the hold, or -1 if all kMaxHolds holds are in use.
  /// - support: fixes the position p, m.
  /// - clamp: also fixes the tangent along `direction`, and the roll. Acts as moved(): call it before the first tick.
  /// - grip: a hand's spring K and damper B, with the force K (tool - x) + B (v_tool - v) on the node (x, v: its
  /// position and velocity), integrated implicitly. It also fixes the present roll (holds_roll) and the present tangent
  /// (directed).
  /// O(1), or O(n) when a tangent is fixed; no allocation.
  int support(int node, Vec p) noexcept;
  int clamp(int node, Vec p, Vec direction) noexcept;
  int grip(int node, double stiffness_N_per_m, double damping_N_s_per_m, Vec tool, bool holds_roll = true,
           bool directed = false) noexcept;
  /// Ends a hold. The next ticks use more substeps while the released thread is fast. @pre `hold` is the index of a
  /// hold.
  void release(int hold) noexcept;

  /// Advances by numerics().tick_s. `goals` are the targets of the holds at the end of the tick, m; for a hold that
  /// does not move, its present target. When the contact budget or the time `left` is used up, the thread is not moved
  /// for the rest of the tick, which report() tells. Cost: O(n) per substep, plus at most Numerics::budget()
  /// instructions for contact; no allocation, no exception.
  void tick(const std::array<Vec, kMaxHolds>& goals, const TimeLeft& left = {}) noexcept;
  void tick() noexcept;
  /// Call after tick(), when the caller's own work for this tick is done. Measures the time since the last clock query,
  /// so that later ticks can reserve it.
  void tick_ended() noexcept { work_.time().end(); }

  /// Does only the remeshing of a tick, with the work that the last tick left. O(n). @return true if nodes moved along
  /// the thread.
  bool remesh() noexcept;
  /// Turns a hold that fixes roll. @pre `direction` is a unit vector. From the next tick on, the hold's director points
  /// along `steer` and, if the hold is directed, its tangent along `direction`.
  void steer(int hold, Vec steer, Vec direction) noexcept;
  /// Switches remeshing inside tick() off (true) or on (false), for callers that call remesh() themselves.
  void hold_mesh(bool on) noexcept { mesh_held_ = on; }

  [[nodiscard]] const TickReport& report() const noexcept { return report_; }
  /// All energies except twist_energy_J(). The elastic energy of contacts is that at the end of the last tick.
  [[nodiscard]] Energy energy() const noexcept {
    Energy e = rod::energy(material_, state_, gravity);
    e.give_J = give_J_;
    return e;
  }
  /// Total energy: all terms of `e`, plus twist, the springs of the holds and the potential of the constant loads.
  [[nodiscard]] double all_J(const Energy& e) const noexcept;

 private:
  using Substep = bool (Rod::*)(double) noexcept;
  static Substep pick(const Parts& parts) noexcept;
  /// Does one time step of dt_s. @return false if the budget or time left is too small; then nothing is moved.
  template <unsigned Bits>
  bool substep(double dt_s) noexcept;
  template <unsigned Bits>
  bool look(double dt_s) noexcept;
  bool relist(long reserve) noexcept;
  template <unsigned Bits>
  bool settle(double dt_s) noexcept;
  void mesh_changed() noexcept;
  [[nodiscard]] bool touches() const noexcept { return parts_.contact || parts_.world; }
  [[nodiscard]] bool sticks() const noexcept { return material_.static_friction > material_.friction; }
  /// Whether Newton's method may solve the contacts. It is for the tight contacts of knots; sweeps solve contact with
  /// floor and bodies, and contact that rolls the thread.
  [[nodiscard]] bool solves_directly() const noexcept { return !parts_.turning && contacts_.only_pairs(); }
  /// `window`: number of nodes from the first to the last on which contacts act. `rows`: work, in instructions, for
  /// setting up contact rows with one pass. `passes`: work for the rows with all their passes.
  struct Allowance {
    long window, rows, passes;
  };
  [[nodiscard]] Allowance work_allowed(bool metric_too) const noexcept;
  std::optional<Effort> choose_rows(double dt_s) noexcept;
  [[nodiscard]] bool prepare_metric(double dt_s) noexcept;
  template <unsigned Bits>
  void move(double dt_s, double share) noexcept;
  template <unsigned Bits>
  std::optional<double> guard(double dt_s) noexcept;
  std::optional<double> guard_unseen(double dt_s) noexcept;
  template <bool Friction>
  Outcome settle_directly(const Effort& effort) noexcept;
  [[nodiscard]] bool can_wait() const noexcept { return solves_directly() && patience_.lasts(); }
  bool put_off() noexcept;
  bool give_up() noexcept;
  double brake(double dt_s) noexcept;

  /// Speed of the fastest hold, and largest relative speed of two holds (if there is only one hold: its speed), m/s.
  struct HandSpeed {
    double fastest = 0.0, apart = 0.0;
    int holds = 0;
  };
  HandSpeed set_hands(const std::array<Vec, kMaxHolds>& goals, std::array<Vec, kMaxHolds>& starts) noexcept;
  void begin_tick(const HandSpeed& hands, const TimeLeft& left) noexcept;
  /// Computes the coupling forces on the hands from the node positions x + ahead_s v (x, v: present positions and
  /// velocities).
  void feel_hands(double ahead_s) noexcept;
  int add_hold(const Hold& hold) noexcept;
  /// Reduces the offsets that remeshing has left: stress-free bends and strains, and changes of the smooth curve's
  /// corners.
  void fade() noexcept;
};

}  // namespace ligature::physics::rod
