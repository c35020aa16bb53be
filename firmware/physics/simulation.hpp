#pragma once
// The simulated thread as the rest of the program sees it: two tools in, nodes and hand forces out.

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <variant>

#include "firmware/physics/time_left.hpp"
#include "firmware/physics/types.hpp"
#include "protocol/scene/scene.hpp"

namespace ligature::physics {

enum class Hand : std::uint8_t { kLeft = 0, kRight = 1 };

/// What a hand does during one tick; world metres and metres per second.
struct ToolInput {
  Vec3 p_WT = Vec3::Zero();
  Vec3 v_WT = Vec3::Zero();
  bool grip = false;
  /// How the tool is turned. Given when the grip closes, the thread's direction and roll there turn with the tool until
  /// it opens (rod model); absent, a grip leaves the direction free, or as it was (hands.pinch_width_m).
  std::optional<Eigen::Quaterniond> R_WT{};
};

/// Which of the paper's conditions (section IV) governs a hand's force.
enum class Propagation : std::uint8_t {
  kNone,  ///< not holding, or propagation is off
  kA,     ///< both neighbouring segments are within their limits: the force stays in the springs
  kB,     ///< a neighbouring segment sits on its limit: axial force passes on
  kC,     ///< as B, while the other hand holds too
};

/// A hand's grasp of the thread. Plain values of the last tick.
struct HandContact {
  int node = -1;             ///< grasped node, the nearest to the middle of the jaws; -1 none
  Vec3 p_WG = Vec3::Zero();  ///< where the thread between the jaws is, m: f_W is the coupling's pull towards there;
                             ///< while the jaws close, as far from the tool as it is from where it shall be by now
  Vec3 v_WG = Vec3::Zero();  ///< its velocity, m/s
  Vec3 f_W = Vec3::Zero();   ///< force ON THE HAND, world newtons, before any device scaling
  Propagation condition = Propagation::kNone;
};

/// The worst of what a tick gave up because its work is bounded, in the order in which it does.
enum class Degradation : std::uint8_t {
  kNone,
  kIterations,  ///< contacts stopped before they settled: a little softer
  kContacts,    ///< the shallowest contacts felt no impulse; they were kept from crossing
  kMotion,      ///< for a part of the tick the thread was not moved: what it might pass was not known
};

/// How a tick of the thread ended.
enum class TickEnd : std::uint8_t {
  kWhole,  ///< all of it was computed
  kWork,   ///< its work was spent: the thread stood still for the rest of it
  kClock,  ///< its time was over: the same
};

/// State of health after a tick.
struct Diagnostics {
  double kinetic_J = 0.0;
  double potential_J = 0.0;      ///< gravity (zero at z = 0), stretch, bending, twist, give of contacts
  double max_stretch = 0.0;      ///< max l / l_rest - 1
  double min_gap_m = 0.0;        ///< surface gap of the closest non-neighbour pair, negative: overlap; +inf: none near
  int contacts = 0;              ///< contacts that carried an impulse in the last step
  bool contact_cap_hit = false;  ///< more contacts than there was room or work for
  Degradation degradation = Degradation::kNone;
  double time_lost = 0.0;  ///< share of the tick in which the thread was not moved
  TickEnd end = TickEnd::kWhole;
  long work = 0;               ///< instructions that contact took, as priced; 0: a model without a bound of work
  int cut_at = -1;             ///< kClock: the question (TimeLeft) that was answered with no
  bool finite = true;          ///< false: frozen at the last finite state, hands open and without force
  int bad_node = -1;           ///< first node that went non-finite or out of range; -1: a tool was
  std::int64_t bad_tick = -1;  ///< tick at which it did
};

/// A thread in its world. Copyable: a copy goes its own way (a scene is rehearsed on one).
class Simulation {
 public:
  /// Builds everything a run needs; the only function that allocates. The string says why it was refused.
  static std::variant<Simulation, std::string> make(const scene::Scene& scene);

  Simulation(const Simulation& other);
  Simulation(Simulation&&) noexcept;
  Simulation& operator=(const Simulation& other);
  Simulation& operator=(Simulation&&) noexcept;
  ~Simulation();

  /// Advances by one scene.time.tick_s in scene.time.substeps equal steps. Never allocates, never throws; once
  /// `diagnostics().finite` is false it does nothing. A tool that is no number, or 1e9 m away, ends it so, too.
  /// When the time left does not do, the thread stands still for the rest of the tick (diagnostics().time_lost).
  void tick(const std::array<ToolInput, 2>& tools, const TimeLeft& left = {}) noexcept;

  /// Positions, m, and velocities, m/s. Converted when first asked for after a tick, so ask from the thread that ticks.
  [[nodiscard]] std::span<const Vec3> nodes_W() const noexcept;
  [[nodiscard]] std::span<const Vec3> velocities_W() const noexcept;
  /// Tension of the edge after each node, N (the last node: of the edge before it), and the angle of the material frame
  /// against the frame carried along without twist from node 0, rad. For those who look; costs O(n). Spans as long as
  /// nodes_W() or shorter.
  void describe(std::span<float> tension_N, std::span<float> turn_rad) const noexcept;
  [[nodiscard]] const HandContact& hand(Hand h) const noexcept;
  [[nodiscard]] const Diagnostics& diagnostics() const noexcept;

  /// What contact may cost in a tick, in instructions (rod/work.hpp), from the next one on; for a thread whose model
  /// has no such bound it does nothing. Stays over reset(); a plant brings its own.
  void set_work(long instructions) noexcept;
  [[nodiscard]] long work() const noexcept;  ///< 0: no such bound

  /// Back to the initial state of the scene, hands open.
  void reset() noexcept;

  /// Takes over shape, motion and grasps of the same thread with other parameters. No allocation. @pre as many nodes
  /// and the same kind of model, else nothing happens and the result is false.
  [[nodiscard]] bool continue_from(const Simulation& other) noexcept;

  /// Replaces the shape and the motion (experiments, restarts); hands open. Fixed nodes stay where they are.
  /// @param p_W, v_W  as many as there are nodes; v_W may be empty for rest. Is one of them no number, the
  /// thread stops as it is, as if it had diverged.
  void set_state(std::span<const Vec3> p_W, std::span<const Vec3> v_W) noexcept;

 private:
  struct Impl;
  explicit Simulation(std::unique_ptr<Impl> impl) noexcept;
  std::unique_ptr<Impl> impl_;
};

}  // namespace ligature::physics
