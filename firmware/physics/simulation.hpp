#pragma once
// The interface (facade) of the suture simulation. Its input are two tools, its output the thread's nodes and the
// forces on the hands.

#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "firmware/physics/contact_point.hpp"
#include "firmware/physics/members.hpp"
#include "firmware/physics/time_left.hpp"
#include "firmware/physics/types.hpp"
#include "protocol/scene/scene.hpp"

namespace ligature::physics {

enum class Hand : std::uint8_t { kLeft = 0, kRight = 1 };

/// Input of one hand for one tick, in world coordinates, m and m/s.
struct ToolInput {
  Vec3 p_WT = Vec3::Zero();
  Vec3 v_WT = Vec3::Zero();
  bool grip = false;
  /// Orientation of the tool (rod model). If it is given when the gripper closes, the held thread's direction and roll
  /// turn with the tool until the gripper opens. Otherwise the direction is free, or fixed if hands.pinch_width_m > 0.
  std::optional<Eigen::Quaterniond> R_WT{};
};

/// Which of the paper's conditions (section IV) governs a hand's force; see propagation.hpp.
enum class Propagation : std::uint8_t {
  kNone,  ///< the hand holds nothing, or force propagation is off
  kA,     ///< both neighbouring segments are inside their length limits: only springs transmit the force
  kB,     ///< a neighbouring segment is at a length limit: it transmits the axial force
  kC,     ///< as B, and the other hand holds the thread too
};

/// A hand's grasp of the thread in the last tick.
struct HandContact {
  int node = -1;             ///< held node nearest to the middle of the jaws; -1: none
  Vec3 p_WG = Vec3::Zero();  ///< position of the thread between the jaws, m, towards which the coupling pulls the hand;
                             ///< while the jaws close: minus the present offset of the coupling (closing.hpp)
  Vec3 v_WG = Vec3::Zero();  ///< velocity of p_WG, m/s
  Vec3 f_W = Vec3::Zero();   ///< force ON THE HAND, world frame, N, before any device scaling
  Propagation condition = Propagation::kNone;
  LIGATURE_MEMBERS(HandContact, node, p_WG, v_WG, f_W, condition)
};

/// What a tick had to give up because its work and time are limited; from mild to severe.
enum class Degradation : std::uint8_t {
  kNone,
  kIterations,  ///< the contact solver stopped before it converged: contacts are slightly softer
  kContacts,    ///< some contacts were not solved; the guard kept strands from crossing
  kMotion,      ///< the thread was not moved for a part of the tick
};

/// How a tick of the thread ended.
enum class TickEnd : std::uint8_t {
  kWhole,  ///< all of it was computed
  kWork,   ///< the work budget was used up: the thread was not moved for a part of the tick
  kClock,  ///< the time was over: the thread was not moved for the rest of the tick
};

/// Measures and error state after a tick.
struct Diagnostics {
  double kinetic_J = 0.0;
  double potential_J = 0.0;      ///< gravity (zero at z = 0), stretch, bending, twist, elasticity of contacts
  double max_stretch = 0.0;      ///< max l / l_rest - 1
  double min_gap_m = 0.0;        ///< surface gap of the closest non-neighbour pair, negative: overlap; +inf: none near
  int contacts = 0;              ///< contacts in the last step (paper models: only those with an impulse or overlap)
  bool contact_cap_hit = false;  ///< there were more contacts than room or work
  Degradation degradation = Degradation::kNone;
  double time_lost = 0.0;  ///< share of the tick in which the thread was not moved
  TickEnd end = TickEnd::kWhole;
  long work = 0;               ///< work charged for contact, in instructions; 0: the model has no budget
  int cut_at = -1;             ///< kClock: number of the clock query that ended the tick (TimeLeft)
  bool finite = true;          ///< false: frozen at the last finite state, hands open and without force
  int bad_node = -1;           ///< if not finite: first node that is not finite or out of range; -1: a tool was
  std::int64_t bad_tick = -1;  ///< if not finite: the tick in which that happened
  LIGATURE_MEMBERS(Diagnostics, kinetic_J, potential_J, max_stretch, min_gap_m, contacts, contact_cap_hit, degradation,
                   time_lost, end, work, cut_at, finite, bad_node, bad_tick)
};

/// A thread in its scene. A copy is independent of the original.
class Simulation {
 public:
  /// Builds a simulation. Only make(), copying, save() and load() allocate memory. @return the simulation, or why the
  /// scene was refused.
  static std::variant<Simulation, std::string> make(const scene::Scene& scene);

  Simulation(const Simulation& other);
  Simulation(Simulation&&) noexcept;
  Simulation& operator=(const Simulation& other);
  Simulation& operator=(Simulation&&) noexcept;
  ~Simulation();

  /// Advances by scene.time.tick_s, in equal time steps. Never allocates, never throws. If a node or a tool has a
  /// coordinate that is not finite or beyond 1e9 m, diagnostics().finite becomes false, and further ticks do nothing.
  /// When the time `left` is used up, the thread is not moved for the rest of the tick (diagnostics().time_lost).
  void tick(const std::array<ToolInput, 2>& tools, const TimeLeft& left = {}) noexcept;

  /// Positions, m, and velocities, m/s, of the nodes. Call only from the thread of execution that calls tick(), because
  /// the first call after a tick may convert them.
  [[nodiscard]] std::span<const Vec3> nodes_W() const noexcept;
  [[nodiscard]] std::span<const Vec3> velocities_W() const noexcept;
  /// For displays. For each node: tension of the segment after it, N (last node: of the segment before it), and angle
  /// by which the thread is twisted between node 0 and this node, rad. The spans are at most as long as nodes_W().
  /// O(n).
  void describe(std::span<float> tension_N, std::span<float> turn_rad) const noexcept;
  /// For displays and studies: writes the contacts that carried a force in the last time step, as many as fit into
  /// `out`. With contact.solver = "paper" there are none, because that solver keeps no forces. O(contacts).
  /// @return number of contacts written
  std::size_t contacts(std::span<ContactPoint> out) const noexcept;
  static constexpr std::size_t kMostContacts = 4096;  ///< enough room for any thread
  [[nodiscard]] const HandContact& hand(Hand h) const noexcept;
  [[nodiscard]] const Diagnostics& diagnostics() const noexcept;

  /// Sets the contact budget of later ticks, in instructions (rod/work.hpp); reset() keeps it. No effect on models
  /// without a budget.
  void set_work(long instructions) noexcept;
  [[nodiscard]] long work() const noexcept;  ///< contact budget of a tick; 0: the model has none

  /// Returns to the initial state of the scene, hands open.
  void reset() noexcept;

  /// Takes over shape, motion and grasps from a simulation with other parameters. No allocation. @return false if the
  /// models or the numbers of nodes differ; then nothing is changed.
  [[nodiscard]] bool continue_from(const Simulation& other) noexcept;

  /// Replaces positions and velocities, for experiments and restarts; the hands open. Fixed nodes keep their positions.
  /// A value that is not finite freezes the thread, as after a divergence.
  /// @param p_W, v_W  one per node; an empty v_W means at rest
  void set_state(std::span<const Vec3> p_W, std::span<const Vec3> v_W) noexcept;

  /// The image of the present state. A simulation of the same scene that loads this image continues exactly as this one
  /// would, to the bit. Allocates. @param ticks number of ticks so far, as the caller counts them; load() returns this
  /// number @see image.hpp
  [[nodiscard]] std::vector<std::byte> save(std::int64_t ticks = 0) const;
  /// Takes over the state from an image. Allocates. A checksum detects a damaged image, but not one that was made on
  /// purpose to do harm. @return the number of ticks given to save(), or one line of text that says why the image was
  /// refused; then nothing is changed.
  [[nodiscard]] std::variant<std::int64_t, std::string> load(std::span<const std::byte> image);

 private:
  struct Impl;
  explicit Simulation(std::unique_ptr<Impl> impl) noexcept;
  std::unique_ptr<Impl> impl_;
};

}  // namespace ligature::physics
