#pragma once
// Roll of every segment about the thread's axis, where it is not the same all along a span: a thread that contacts
// turn, or one that is born curved. Twist (twist.hpp) is the cheaper law for all others.

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "firmware/physics/rod/state.hpp"

namespace ligature::physics::rod {

/// Material frames: segment j carries a unit director u_j across its tangent t_j and turns at rate w_j about it.
///   I_j dw_j/dt = M_{j+1} - M_j + bending + contacts,   I_j = rho r^2 l_j / 2,   M_i = C (m_i / l_i - born twist),
/// m_i the angle from u_{i-1}, carried from t_{i-1} to t_i without twist, to u_i; l_i = (l_{i-1} + l_i) / 2. A hold
/// with roll stands between the halves of its two segments: M = 2 C angle / l_j each [Bergou 2008, material frames,
/// with the thread's own inertia]. A thread born with curvature k about a material axis is at rest where
///   t_i - t_{i-1} = 2 sin(k l_i / 2) d_i,   d_i the mean director of the vertex,
/// which turns it by k l_i Q_i . (t_i x d_i), Q_i the bending moment. Implicit Euler in w (tridiagonal); the mesh's
/// tangents are followed once a tick. Bends that set add to what the thread was born with (spin_set.cpp).
class Spin {
 public:
  void reserve(int nodes);

  /// Directors untwisted along the thread as it lies; at rest. Holds with roll take theirs.
  void start(const Material& material, State& state) noexcept;
  /// A hold's director that twists nothing. @pre after start().
  void attach(State& state, int hold) const noexcept;

  /// What Refine's fading of State::rest_bend must leave: call before, with its factors.
  [[nodiscard]] std::span<const Vec> born() const noexcept { return born_; }
  void before_fading(State& state, std::span<const double> fade) const noexcept;
  /// Once a tick: directors follow the tangents (and nodes that moved along the thread), angles and moments are
  /// measured.
  /// @param remeshed  State::rest_bend was set anew, the born part included.
  /// @param once  the segments roll here, for the whole tick, and not in its substeps: without contacts that turn them
  /// and births that do, roll is as quick as twist, and that crosses the thread within a tick.
  /// What a hold was turned since the last tick, it turns evenly in this one.
  void update(const Material& material, State& state, Forces& forces, double tick_s, bool remeshed,
              bool once = false) noexcept;

  /// A substep's flow of the bends that set, at the positions of now. @return energy dissipated, J.
  double yield(const Material& material, State& state) noexcept;
  /// Back bend of a vertex, as a change of t: the stress-free bend is set_fraction of it.
  [[nodiscard]] Vec set(int vertex) const noexcept { return set_[static_cast<std::size_t>(vertex)]; }

  /// Matrix and right-hand side of a substep; solves for the rates without contacts.
  void assemble(const Material& material, const State& state, double dt_s) noexcept;
  /// Rates with the torque impulses noted since assemble(); then everything turns for dt_s.
  void advance(const Material& material, State& state, Forces& forces, double dt_s) noexcept;

  // For contacts, between assemble() and advance().
  [[nodiscard]] double rate(int segment) const noexcept { return rate_[static_cast<std::size_t>(segment)]; }
  [[nodiscard]] Vec tangent(int segment) const noexcept { return tangent_[static_cast<std::size_t>(segment)]; }
  /// Rate that a unit torque impulse on a segment gives it, 1/(kg m^2).
  [[nodiscard]] double answer(int segment) const noexcept { return answer_[static_cast<std::size_t>(segment)]; }
  /// Torque impulse on a segment, N m s: all rates in [first, last] answer at once.
  void push(int segment, double torque_Nms, int first, int last) noexcept;
  /// Rates and torque impulses of [first, last], to come back to.
  void save(int first, int last) noexcept;
  void restore(int first, int last) noexcept;

  [[nodiscard]] double energy_J(const Material& material, const State& state) const noexcept;
  [[nodiscard]] Vec director(int segment) const noexcept { return director_[static_cast<std::size_t>(segment)]; }

 private:
  void follow(const State& state) noexcept;
  void resample(const State& state) noexcept;
  void measure(const State& state, double tick_s, bool remeshed) noexcept;
  void measure_hold(const State& state, const Hold& hold, double tick_s, bool fresh) noexcept;
  void give_moments(const Material& material, const State& state, Forces& forces) const noexcept;
  [[nodiscard]] double into_vertex(const Material& m, const State& state, std::size_t i) const noexcept;
  [[nodiscard]] double out_of_vertex(const Material& m, const State& state, std::size_t i) const noexcept;
  void bear(const Material& material, State& state, bool keep_rest) noexcept;
  void turn_born(const Material& material, State& state, double dt_s) noexcept;
  [[nodiscard]] Vec shape_of(const Material& material, std::size_t i) noexcept;
  void set_to_material() noexcept;
  void set_to_world(const Material& material, const Mesh& mesh) noexcept;
  void resample_set(double length_m) noexcept;
  void eliminate() noexcept;
  void solve(const std::vector<double>& b) noexcept;
  /// Length of thread that belongs to a vertex with two segments.
  [[nodiscard]] static double share_of_vertex(const Mesh& mesh, std::size_t i) noexcept {
    return 0.5 * (mesh.rest[i - 1] + mesh.rest[i]);
  }

  std::vector<Vec> director_, tangent_;
  std::vector<double> rate_, rolled_;  // rad/s; rad since the tick began
  std::vector<double> middle_m_;       // material coordinates of the segments' middles, as of director_
  std::vector<double> before_,
      after_;  // angles at vertex i: free: before_ = m_i; held: to and from the hold's director
  std::vector<double> drift_before_, drift_after_;  // what the turning of a hold adds to them, rad/s
  std::vector<char> held_, was_held_;
  std::vector<Vec> normal_, binormal_;  // d_i and t_i x d_i of the vertices
  std::vector<Vec> born_, across_;      // stress-free bend, and where it goes when the thread rolls
  std::vector<double> born_size_;       // its part along d_i that the thread was born with
  std::vector<Vec> set_;                // z_i: in the world during a tick; along d_i, t_i x d_i between ticks
  std::vector<double> limit2_;          // squared bend beyond which it moves
  std::vector<double> torque_;          // impulse on each segment since assemble()
  std::vector<double> diag_, off_, rhs_, down_, up_, answer_, saved_rate_, saved_torque_;
  // Scratch of resample(): frames by the old mesh.
  std::vector<Vec> old_director_, old_tangent_;
  std::vector<double> old_rate_, old_middle_m_;
  std::vector<Vec> old_set_;
};

}  // namespace ligature::physics::rod
