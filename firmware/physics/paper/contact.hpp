#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "firmware/physics/contact_point.hpp"
#include "firmware/physics/members.hpp"
#include "firmware/physics/paper/broad_phase.hpp"
#include "firmware/physics/paper/bvh.hpp"
#include "firmware/physics/paper/contact_row.hpp"
#include "firmware/physics/paper/roomy_vector.hpp"
#include "firmware/physics/paper/sweep_and_prune.hpp"
#include "firmware/physics/paper/thread.hpp"
#include "protocol/scene/scene.hpp"

namespace ligature::physics {

/// A capsule with the thread's radius, whose motion is prescribed: a gripper, or a hook that carries a fixed node.
struct Obstacle {
  V3<double> p0_m{}, p1_m{}, v_m_per_s{};
  int skip_first = 0, skip_last = -1;  ///< range of segments without contact (those that it holds)
  bool present = false;
  LIGATURE_MEMBERS(Obstacle, p0_m, p1_m, v_m_per_s, skip_first, skip_last, present)
};

struct ContactSettings {
  double stick = 0.3, slip = 0.3;  ///< static and kinetic friction coefficients
  int skip = 2;                    ///< segments whose indices differ by less cannot touch: neighbours along the thread
  std::optional<double> desk_m;    ///< height of the desk
  scene::BroadPhase broad_phase = scene::BroadPhase::kBrute;  ///< never kAuto: build_contact() chooses
  LIGATURE_MEMBERS(ContactSettings, stick, slip, skip, desk_m, broad_phase)
};

/// Two bodies that may touch soon. This data is kept from step to step; the gap is measured again only if it may be
/// small.
struct Candidate {
  enum class Kind : std::int8_t { kSegments, kObstacle, kDesk };
  Kind kind = Kind::kSegments;
  int first = 0;           ///< segment (desk: node)
  int second = 0;          ///< segment, or index of the obstacle
  double gap_m = 0.0;      ///< surface gap when last measured
  double travel_m = 0.0;   ///< value of ContactSolver::travel_m_ (motion so far) when last measured
  std::int64_t step = -1;  ///< step in which it was last measured
  V3<double> normal{};     ///< unit, when last measured
  Pack impulse{};          ///< of the last step, N s: the warm start
  LIGATURE_MEMBERS(Candidate, kind, first, second, gap_m, travel_m, step, normal, impulse)
};

struct ContactReport {
  int active = 0;
  bool cap_hit = false;
  double min_gap_m = 0.0;
  int sweeps = 0;
  LIGATURE_MEMBERS(ContactReport, active, cap_hit, min_gap_m, sweeps)
};

/// Contact of the thread with itself, the desk and obstacles, with static and kinetic Coulomb friction. Before
/// positions are advanced, impulses within the friction cone change the velocities so that no gap closes faster than
/// gap / dt. So even a fast approach ends at touch. Solved by projected Gauss-Seidel with warm start.
class ContactSolver {
 public:
  static constexpr int kObstacles = 8;

  ContactSolver() = default;
  ContactSolver(const ThreadModel& model, const ContactSettings& settings);

  std::array<Obstacle, kObstacles>& obstacles() noexcept { return obstacles_; }

  /// Changes the velocities so that no overlap arises in the coming time step (model.step_s).
  void solve(const ThreadModel& model, ThreadState& state) noexcept;

  /// Call after each step. @param speed_m_per_s upper bound of the nodes' speeds in that step
  void moved(double speed_m_per_s, double step_s) noexcept { travel_m_ += 2.0 * speed_m_per_s * step_s; }

  [[nodiscard]] const ContactReport& report() const noexcept { return report_; }
  /// @see Simulation::contacts
  std::size_t points(const ThreadState& state, double step_s, std::span<ContactPoint> out) const noexcept;
  void forget() noexcept;
  /// The members that an image saves (image.hpp): all but `tree`, which every search for candidates builds again.
  [[nodiscard]] static auto members(ContactSolver& self) noexcept {
    auto& [settings, radius_m, nodes, obstacles, known, spheres, sweep, tree, pairs, candidates, old_candidates, due_m,
           gap_m, rows, velocity, travel_m, found_at_m, margin_m, step, report] = self;
    return std::tie(settings, radius_m, nodes, obstacles, known, spheres, sweep, pairs, candidates, old_candidates,
                    due_m, gap_m, rows, velocity, travel_m, found_at_m, margin_m, step, report);
  }

 private:
  void find_candidates(const ThreadState& state) noexcept;
  void find_pairs(double reach_m) noexcept;
  void find_near_obstacle(const ThreadState& state, int obstacle) noexcept;
  void keep(const ThreadState& state, Candidate candidate) noexcept;
  void inherit_impulses() noexcept;
  void measure(const ThreadState& state, Candidate& c, ContactRow& row) const noexcept;
  [[nodiscard]] bool finish_row(const ThreadModel& model, const Candidate& c, ContactRow& row) const noexcept;
  void gather_velocities(const ThreadState& state) noexcept;
  void orient(Candidate& c, const V3<double>& apart, double distance_m, const V3<double>& axis) const noexcept;
  void index_candidates() noexcept;
  void remember(int candidate) noexcept;
  [[nodiscard]] double fastest(const ThreadState& state) noexcept;
  void try_row(const ThreadModel& model, const ThreadState& state, double near_m, int candidate) noexcept;
  void make_rows(const ThreadModel& model, const ThreadState& state, double near_m) noexcept;
  void sweep(double step_s) noexcept;

  ContactSettings settings_;
  double radius_m_ = 0.0;
  int nodes_ = 0;
  std::array<Obstacle, kObstacles> obstacles_{}, known_{};  ///< in this step, and in the last one
  SegmentSpheres spheres_;
  Sweep sweep_;
  SphereTree tree_;
  PairList pairs_;
  RoomyVector<Candidate> candidates_, old_candidates_;
  Lane due_m_;  ///< per candidate: value of travel_m_ up to which its gap is certainly positive
  Lane gap_m_;  ///< per candidate: gap when last measured; infinite for the desk and obstacles
  RoomyVector<ContactRow> rows_;
  std::vector<NodeVelocity> velocity_;  ///< of all nodes, and of an immobile one for desk and obstacles
  double travel_m_ = 0.0;               ///< upper bound of how much any gap has closed since the start
  double found_at_m_ = 0.0;             ///< travel_m_ when candidates were last found
  double margin_m_ = -1.0;  ///< gap below which all pairs became candidates in that search; < 0: search again
  std::int64_t step_ = 0;
  ContactReport report_;
};

}  // namespace ligature::physics
