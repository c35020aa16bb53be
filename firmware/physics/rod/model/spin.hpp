#pragma once
// A roll angle for every segment. It is needed where twist is not uniform along a span: if friction rolls the thread,
// or if the thread is curved when stress-free. Otherwise the cheaper model of twist.hpp is used.

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "firmware/physics/members.hpp"
#include "firmware/physics/rod/model/state.hpp"

namespace ligature::physics::rod {

/// Material frames: segment j has a unit director u_j across its tangent t_j, fixed to its material, and rolls at the
/// rate w_j about the tangent:
///   I_j dw_j/dt = M_{j+1} - M_j + bending + contacts,   I_j = rho r^2 l_j / 2,   M_i = C (m_i / l_i - rest twist)
/// I_j: moment of inertia, rho: mass per length, r: radius, l_j: length of the segment. M_i: twisting moment at vertex
/// i, C: twisting stiffness, l_i: mean length of the vertex's two segments. m_i: twist angle at the vertex, from the
/// director u_{i-1}, parallel-transported from t_{i-1} to t_i, to u_i. A hold that fixes roll acts on the halves of its
/// two segments, each with M = 2 C angle / l_j [Bergou 2008, material frames, here with the thread's rotational
/// inertia].
///
/// A thread with the rest curvature k about a material axis has no bending moment where
///   t_i - t_{i-1} = 2 sin(k l_i / 2) d_i      (d_i: mean director of the vertex).
/// Elsewhere the bending moment Q_i makes the thread roll, by the torque k l_i Q_i . (t_i x d_i). Plastic bends add to
/// the rest curvature (spin_set.cpp).
///
/// Implicit Euler in w (tridiagonal system). Frames are aligned with the new tangents once per tick.
class Spin {
 public:
  void reserve(int nodes);

  /// Sets the initial frames: at rest, and without twist along the present shape. Holds that fix roll get matching
  /// directors. Replaces the part born() of State::rest_bend.
  void start(const Material& material, State& state) noexcept;
  /// Sets the director of a hold so that the hold causes no twist. @pre after start().
  void attach(State& state, int hold) const noexcept;

  /// Part of State::rest_bend that is the thread's own rest curvature. It must not fade, as the offsets of remeshing
  /// do.
  [[nodiscard]] std::span<const Vec> born() const noexcept { return born_; }
  /// Call before start() if State::rest_bend is of a thread without frames, so that it has no such part.
  void forget_born() noexcept { std::fill(born_.begin(), born_.end(), Vec{}); }
  /// Call before Refine::fade_offsets(), with the same factors. Scales up the part born() of State::rest_bend, so that
  /// this part has its old value after the fading.
  void before_fading(State& state, std::span<const double> fade) const noexcept;
  /// Call once per tick. Aligns the frames with the new tangents (and the new mesh), and computes angles and moments. A
  /// hold's rotation since the last tick is spread evenly over this tick.
  /// @param remeshed true: nodes moved, and State::rest_bend was computed again, including its part born()
  /// @param once the roll advances here by the whole tick, instead of in every substep. That is enough if neither
  /// friction nor rest curvature rolls the thread, because twist waves cross it in less than a tick.
  void update(const Material& material, State& state, Forces& forces, double tick_s, bool remeshed,
              bool once = false) noexcept;

  /// Computes the plastic flow of all bends in a substep, at the present positions. @return energy dissipated, J.
  double yield(const Material& material, State& state) noexcept;
  /// Plastic bend z_i of a vertex, as a change of the unit tangent: how far the friction slider of the plastic model
  /// has moved (spin_set.cpp). The stress-free bend has changed by set_fraction x z_i.
  [[nodiscard]] Vec set(int vertex) const noexcept { return set_[vertex]; }

  /// Sets up and solves a substep's system for the roll rates w_j, without torques of contacts.
  void assemble(const Material& material, const State& state, double dt_s) noexcept;
  /// Solves the system again with the torque impulses that contacts have applied since assemble(), then rolls all
  /// frames for the time dt_s.
  void advance(const Material& material, State& state, Forces& forces, double dt_s) noexcept;

  /// Roll rate, rad/s, and tangent of a segment, for contacts. Valid between assemble() and advance().
  [[nodiscard]] double rate(int segment) const noexcept { return rate_[segment]; }
  [[nodiscard]] Vec tangent(int segment) const noexcept { return tangent_[segment]; }
  /// Change of a segment's rate per unit torque impulse on it, 1/(kg m^2).
  [[nodiscard]] double answer(int segment) const noexcept { return answer_[segment]; }
  /// Applies a torque impulse to a segment, N m s, and updates the rates of all segments in [first, last].
  void push(int segment, double torque_Nms, int first, int last) noexcept;
  /// Saves and restores rates and torque impulses of the segments first to last.
  void save(int first, int last) noexcept;
  void restore(int first, int last) noexcept;

  [[nodiscard]] double energy_J(const Material& material, const State& state) const noexcept;
  LIGATURE_MEMBERS(Spin, director, tangent, rate, rolled, middle_m, before, after, drift_before, drift_after, held,
                   was_held, normal, binormal, born, across, born_size, set, limit2, torque, diag, off, rhs, down, up,
                   answer, saved_rate, saved_torque, old_director, old_tangent, old_rate, old_middle_m, old_set)

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
  std::vector<double> rate_, rolled_;  // w_j, rad/s; angle turned since the tick began, rad
  std::vector<double> middle_m_;       // material coordinates of the segments' midpoints when director_ was set
  // Twist angles at vertex i, rad. Without a hold, before_ is the angle m_i between the directors of its two segments.
  // With a hold, before_ is the angle from the director of the preceding segment to that of the hold, and after_ the
  // angle from the director of the hold to that of the following segment
  std::vector<double> before_, after_;
  std::vector<double> drift_before_, drift_after_;  // rates of these angles by the hold's rotation, rad/s
  std::vector<char> held_, was_held_;
  std::vector<Vec> normal_, binormal_;  // mean director d_i of each vertex, and t_i x d_i
  std::vector<Vec> born_, across_;      // stress-free bend, and its derivative by the roll angle
  std::vector<double> born_size_;       // 2 sin(k l_i / 2): stress-free bend without its plastic part, along d_i
  std::vector<Vec> set_;        // plastic bends z_i: world coordinates, but inside update() along d_i and t_i x d_i
  std::vector<double> limit2_;  // square of the yield limit of a vertex
  std::vector<double> torque_;  // torque impulse on each segment since assemble()
  std::vector<double> diag_, off_, rhs_, down_, up_, answer_, saved_rate_, saved_torque_;
  // Scratch of resample(): frames of the old mesh.
  std::vector<Vec> old_director_, old_tangent_;
  std::vector<double> old_rate_, old_middle_m_;
  std::vector<Vec> old_set_;
};

}  // namespace ligature::physics::rod
