#pragma once
// A scene as plain numbers: what scene files say (scene_file.hpp reads them) and every program understands.
// SI units; vectors are x, y, z in the world frame W (x right, y away from the person, z up).

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
enum class SwivelDamper : std::uint8_t { kInternal, kPaper };  ///< four-point dihedral rate, or the paper's (13)-(15)
enum class QuadraticStretch : std::uint8_t {
  kStiff,
  kPrinted
};  ///< model 5: constant that stretches less, or Table I's

/// How dampers act: on the velocities they leave behind (stable at any step), or as printed, on those they find.
enum class Damping : std::uint8_t { kImplicit, kExplicit };
/// Order of the Euler update: velocity first, or position and velocity both from the old state.
enum class Integrator : std::uint8_t { kSemiImplicit, kForward };

/// The paper's Table I, per node; used by paper-1 .. paper-5.
struct PaperParameters {
  double node_mass_kg = 0.05;    ///< m
  double stretch_N = 800.0;      ///< k_l: force per unit strain, i.e. EA
  double stretch_damping = 1.0;  ///< k_d, N s/m
  double bend = 10.0;            ///< k_ts, N m (torque is k_ts alpha / pi)
  double bend_damping = 0.05;    ///< k_td, N m s
  double swivel_damping = 0.2;   ///< k_sw, N s
  /// Node count at which the values above hold, 2 .. 5000. When given, another `nodes` simulates the same thread: mass,
  /// EA, EI and losses per length are kept. When absent, the values are per node whatever `nodes` is, as in the paper.
  std::optional<int> reference_nodes;                 ///< key suture.reference_nodes
  Damping damping = Damping::kImplicit;               ///< key suture.damping = "implicit" | "explicit"
  Integrator integrator = Integrator::kSemiImplicit;  ///< key suture.integrator = "semi-implicit" | "forward"
  double air_drag_per_s = 0.0;                        ///< key suture.air_drag_per_s: a = -c v, 0 .. 1e6
  SwivelDamper swivel = SwivelDamper::kInternal;
  QuadraticStretch quadratic_stretch = QuadraticStretch::kStiff;
};

enum class Spacing : std::uint8_t { kUniform, kAdaptive };
enum class Accuracy : std::uint8_t { kFast, kBalanced, kFine };

/// A rod's material, per length; suture.model = "rod". Keys of [suture] with these names; `preset` fills them in.
struct RodParameters {
  double density_kg_per_m = 8e-5;
  double EA_N = 71.0;                  ///< axial stiffness
  double EI_N_m2 = 4e-7;               ///< bending stiffness
  double GJ_N_m2 = 2.86e-7;            ///< twisting stiffness; 0: twist is not modelled
  double rest_curvature_per_m = 0.0;   ///< of the thread without stress, about an axis that is fixed in its material
  double rest_twist_per_m = 0.0;       ///< rad/m: that axis turns along the thread; with a curvature, a helix
  std::optional<double> yield_strain;  ///< of the outer fibre, beyond which a bend stays; absent: never
  double set_fraction = 0.5;           ///< share of the bending stiffness that gives way there
  double damping_s = 2e-3;             ///< Kelvin-Voigt time of bending
  double stretch_damping_s = 5e-4;     ///< of stretch
  double air_drag_per_s = 5.0;         ///< a = -c v
  Spacing spacing = Spacing::kAdaptive;
  Accuracy accuracy = Accuracy::kBalanced;
  int work_instructions = 0;  ///< what contact may cost in a tick; 0: as `accuracy` has it, or what the rig can afford
};

struct Suture {
  Model model = Model::kPaper4;
  int nodes = 50;
  double length_m = 5.0;
  double radius_m = 0.05;
  std::string initial = "hanging";      ///< "hanging": straight down from node 0; else the file it was read from
  std::vector<Vec> initial_polyline_m;  ///< empty when hanging; else equally far apart, as many as
                                        ///< nodes, or finer for a rod whose nodes move along it
  PaperParameters paper;
  RodParameters rod;
};

struct Contact {
  ContactSolver solver = ContactSolver::kImplicit;
  double friction = 0.3;                  ///< kinetic Coulomb coefficient; key contact.friction
  std::optional<double> static_friction;  ///< same as friction when absent
  bool turns_thread = false;              ///< friction turns the thread about its axis: it rolls; rod model only
  double repulsion_N_per_m = 100.0;       ///< k_rs of (2), solver "paper" only
  double repulsion_N_s_per_m = 5.0;       ///< k_rd of (2), solver "paper" only
  bool friction_cap = true;  ///< key contact.friction_cap; solver "paper": at most stop slip; false: as printed
  BroadPhase broad_phase = BroadPhase::kAuto;
};

struct FixedNode {
  int node = 0;  ///< -1 is the last
  Vec position_m{0.0, 0.0, 0.0};
  std::optional<Vec> direction;  ///< clamps the tangent too
};

struct Load {
  int node = 0;
  Vec force_N{0.0, 0.0, 0.0};
};

/// A fixed round bar, key world.pegs = [{from_m, to_m, radius_m}]; rod model only.
struct Peg {
  Vec from_m{0.0, 0.0, 0.0}, to_m{0.0, 0.0, 0.0};
  double radius_m = 0.0;
};

struct World {
  Vec gravity_m_per_s2{0.0, 0.0, -9.8};
  std::vector<FixedNode> fixed;
  std::vector<Load> loads;
  std::vector<Peg> pegs;
  std::optional<double> desk_height_m;
  bool grippers_collide = true;
  bool frame_collides = true;  ///< a hook above each fixed node
};

struct Time {
  double tick_s = 0.001;
  int substeps = 1;
};

struct Hands {
  double coupling_N_per_m = 1200.0;
  double coupling_N_s_per_m = 6.0;
  std::optional<double> reach_m;        ///< jaws close on thread no further from the tip than this; absent: any
  double pinch_width_m = 0.0;           ///< jaws hold the nodes across their width, and their direction; 0: one node
  std::optional<double> pinch_force_N;  ///< of each jaw on the thread: it slips at 2 mu times this; absent: never
  /// Device side of the coupling, at the device; absent: rigid, the tool is where the device is.
  std::optional<double> device_N_per_m;
  double device_N_s_per_m = 0.5;
  bool passivity = true;            ///< key hands.passivity: the controller over each device port acts
  bool override_passivity = false;  ///< key hands.override_passivity: take a coupling beyond the admissible one
  double energy_credit_J = 0.0;     ///< opening balance of each port's account; 0: all must be earned
  double force_scale = 0.003;       ///< world newtons -> device newtons
  double max_force_N = 3.3;         ///< at the device
  bool propagation = false;
  double min_length = 0.9;  ///< of rest length
  double max_length = 1.1;
  double workspace_scale = 20.0;          ///< world metres per device metre
  Vec workspace_origin_m{0.0, 0.0, 0.0};  ///< world point of the device's home pose
};

struct Scene {
  Suture suture;
  Contact contact;
  World world;
  Time time;
  Hands hands;
};

/// One line a person can act on: where, what was found, what is allowed.
struct Error {
  std::string text;
};

}  // namespace ligature::scene
