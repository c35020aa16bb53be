#pragma once
// A scene as plain data: the content of scene files (read by scene_file.hpp), used by all programs. SI units; vectors
// are x, y, z in the world frame W (x right, y away from the person, z up).

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace ligature::scene {

using Vec = std::array<double, 3>;

enum class Model : std::uint8_t { kPaper1, kPaper2, kPaper3, kPaper4, kPaper5, kRod };
enum class ContactSolver : std::uint8_t { kNone, kPaper, kImplicit };
enum class BroadPhase : std::uint8_t { kAuto, kBrute, kSweep, kBvh };
/// How the swivel damper's force is computed: from the rate of the dihedral angle of four points, or by equations
/// (13)-(15) of the paper.
enum class SwivelDamper : std::uint8_t { kInternal, kPaper };
/// Stretch constant of paper-5: 100 times the one printed in the paper's Table I, or the printed one.
enum class QuadraticStretch : std::uint8_t { kStiff, kPrinted };

/// Evaluation of damping: implicit, with the velocities after the step (stable at any step size), or explicit, as
/// printed in the paper.
enum class Damping : std::uint8_t { kImplicit, kExplicit };
/// Euler update: semi-implicit (velocity first), or forward (both from the old state).
enum class Integrator : std::uint8_t { kSemiImplicit, kForward };

/// Parameters of the paper's Table I, per node; used by paper-1 .. paper-5.
struct PaperParameters {
  double node_mass_kg = 0.05;    ///< m: mass of a node
  double stretch_N = 800.0;      ///< k_l: force per unit strain, i.e. EA
  double stretch_damping = 1.0;  ///< k_d: damping of stretch, N s/m
  double bend = 10.0;            ///< k_ts, N m: the bending torque is k_ts alpha / pi at a bending angle alpha
  double bend_damping = 0.05;    ///< k_td: damping of bending, N m s
  double swivel_damping = 0.2;   ///< k_sw: damping of swivel, N s
  /// Node count for which the values above hold, 2 .. 5000. If given, another `nodes` simulates the same thread: mass,
  /// EA, EI and losses per length are kept. If absent, the values are per node for any `nodes`, as in the paper.
  std::optional<int> reference_nodes;                 ///< key suture.reference_nodes
  Damping damping = Damping::kImplicit;               ///< key suture.damping = "implicit" | "explicit"
  Integrator integrator = Integrator::kSemiImplicit;  ///< key suture.integrator = "semi-implicit" | "forward"
  double air_drag_per_s = 0.0;                        ///< acceleration -c v, 0 .. 1e6
  SwivelDamper swivel = SwivelDamper::kInternal;
  QuadraticStretch quadratic_stretch = QuadraticStretch::kStiff;
};

enum class Spacing : std::uint8_t { kUniform, kAdaptive };
enum class Accuracy : std::uint8_t { kFast, kBalanced, kFine };

/// A part of the thread with a bending stiffness of its own.
struct StiffRegion {
  double from_m = 0.0, to_m = 0.0;  ///< distance along the thread from node 0
  double EI_N_m2 = 0.0;
};

/// Properties of a rod; suture.model = "rod". The keys of [suture] have these names; `preset` sets several of them.
struct RodParameters {
  double density_kg_per_m = 8e-5;
  double EA_N = 71.0;                 ///< axial stiffness
  double EI_N_m2 = 4e-7;              ///< bending stiffness
  double GJ_N_m2 = 2.86e-7;           ///< twisting stiffness; 0: twist is not modelled
  double rest_curvature_per_m = 0.0;  ///< curvature without stress, about an axis fixed in the material
  /// Twist without stress: rotation of the axis of rest_curvature along the thread, rad/m; both together give a helix
  double rest_twist_per_m = 0.0;
  std::optional<double> yield_strain;  ///< strain of the outer fibre above which bending is plastic; absent: never
  double set_fraction = 0.5;           ///< fraction of the bending stiffness that yields above yield_strain
  std::vector<StiffRegion> stiffness_profile;  ///< where the bending stiffness is not EI_N_m2; in order, no overlap
  double damping_s = 2e-3;                     ///< Kelvin-Voigt time constant of bending
  double stretch_damping_s = 5e-4;             ///< Kelvin-Voigt time constant of stretching
  double air_drag_per_s = 5.0;                 ///< acceleration -c v
  Spacing spacing = Spacing::kAdaptive;
  Accuracy accuracy = Accuracy::kBalanced;
  /// Contact budget per tick, in instructions; 0: by `accuracy`, or what the machine can afford
  int work_instructions = 0;
};

struct Suture {
  Model model = Model::kPaper4;
  int nodes = 50;
  double length_m = 5.0;
  double radius_m = 0.05;
  std::string initial = "hanging";  ///< "hanging": straight down from node 0; else the file name of the shape
  /// Points of the start shape, equally spaced: one per node, or more for a rod with adaptive spacing; empty if hanging
  std::vector<Vec> initial_polyline_m;
  PaperParameters paper;
  RodParameters rod;
};

struct Contact {
  ContactSolver solver = ContactSolver::kImplicit;
  double friction = 0.3;                  ///< kinetic Coulomb coefficient; key contact.friction
  std::optional<double> static_friction;  ///< equal to friction if absent
  bool turns_thread = false;              ///< whether friction can roll the thread about its axis; rod model only
  double repulsion_N_per_m = 100.0;       ///< k_rs of the paper's (2), stiffness; solver "paper" only
  double repulsion_N_s_per_m = 5.0;       ///< k_rd of the paper's (2), damping; solver "paper" only
  /// Key contact.friction_cap, solver "paper" only. true: friction can stop slip but not reverse it; false: the paper's
  /// formula without this limit
  bool friction_cap = true;
  BroadPhase broad_phase = BroadPhase::kAuto;
};

struct FixedNode {
  int node = 0;  ///< -1: the last node
  Vec position_m{0.0, 0.0, 0.0};
  std::optional<Vec> direction;  ///< if set, the tangent is clamped as well
};

struct Load {
  int node = 0;
  Vec force_N{0.0, 0.0, 0.0};
};

/// A fixed round bar, key world.pegs = [{from_m, to_m, radius_m}]; rod model only. With a surface speed it is a drum
/// that turns about its axis.
struct Peg {
  Vec from_m{0.0, 0.0, 0.0}, to_m{0.0, 0.0, 0.0};
  double radius_m = 0.0;
  double surface_m_per_s = 0.0;  ///< positive: right-handed about the direction from from_m to to_m
};

struct World {
  Vec gravity_m_per_s2{0.0, 0.0, -9.8};
  std::vector<FixedNode> fixed;
  std::vector<Load> loads;
  std::vector<Peg> pegs;
  std::optional<double> desk_height_m;
  bool grippers_collide = true;
  bool frame_collides = true;  ///< each fixed node has a hook above it, which the thread collides with
  // With contact.solver = "paper" grippers_collide and frame_collides are false by default. Such a scene is refused if
  // it sets one of them to true, or has a desk.
};

struct Time {
  double tick_s = 0.001;
  int substeps = 1;
};

struct Hands {
  double coupling_N_per_m = 1200.0;
  double coupling_N_s_per_m = 6.0;
  std::optional<double> reach_m;  ///< jaws grip thread within this distance of the tip; absent: at any distance
  double pinch_width_m = 0.0;     ///< jaws hold all nodes within their width, and their direction; 0: one node
  /// Force of each jaw on the thread, which slips at 2 mu times this; absent: never slips
  std::optional<double> pinch_force_N;
  /// Stiffness of the coupling's device side, at the device; absent: rigid, the tool is where the device is.
  std::optional<double> device_N_per_m;
  double device_N_s_per_m = 0.5;
  bool passivity = true;            ///< key hands.passivity: whether the passivity controller limits forces
  bool override_passivity = false;  ///< key hands.override_passivity: allow a coupling above the stability limit
  double energy_credit_J = 0.0;     ///< start value of each port's energy account; 0: the hand must first put energy in
  double force_scale = 0.003;       ///< factor from world newtons to device newtons
  double max_force_N = 3.3;         ///< force limit at the device
  bool propagation = false;
  double min_length = 0.9;  ///< limit of a segment's length / rest length, with propagation only
  double max_length = 1.1;
  double workspace_scale = 20.0;          ///< factor from device metres to world metres
  Vec workspace_origin_m{0.0, 0.0, 0.0};  ///< world position of the device's home pose
};

struct Scene {
  Suture suture;
  Contact contact;
  World world;
  Time time;
  Hands hands;
};

/// One line that tells a user where, what was found, and what is allowed.
struct Error {
  std::string text;
};

}  // namespace ligature::scene
