// Frictionless contact tests: two crossing threads under tension, and a heavy rod lifted from a plane.

#include <cmath>
#include <limits>

#include "host/lab/validate/reference.hpp"
#include "host/lab/validate/specimen.hpp"

namespace ligature::validate {
namespace {

/// Number of segments of each strand. All segments are equally long, and each strand has a node in its middle.
struct Shares {
  int a, b;
};
Shares shares_of(int nodes, double a_m, double b_m) {
  const int a = a_m == b_m ? 16 : 20, b = static_cast<int>(std::lround(a * b_m / a_m));  // ratios 20 : 12 and 20 : 10
  return nodes >= 200 ? Shares{4 * a, 4 * b} : Shares{a, b};
}

struct Crossing {
  double z_a = 0.0, z_b = 0.0, force_N = 0.0, tension_N = 0.0;
};

/// Both strands are parts of one thread: strand A along x, a slack connecting piece off to the side, strand B along y
/// below A.
Crossing crossing(const Subject& subject, const Row& row) {
  const double a = number(row, "a_m"), b = number(row, "b_m"), H = number(row, "H_m"), d = number(row, "d_contact_m");
  // The reference's thread has the tension T = T0 + EA (l / l0 - 1), l its length. This equals a Hookean thread with
  // stiffness EA - T0 and rest length l0 (EA - T0) / EA.
  const double EA = number(row, "EA_N") - number(row, "T0_A_N"), shorter = EA / number(row, "EA_N");
  const auto shares = shares_of(subject.nodes, a, b);
  const int ka = shares.a, kb = shares.b;
  auto scene = real_thread(subject, 1.0, 0.0);
  scene.suture.radius_m = 0.5 * d;
  const double l = 2.0 * a * shorter / ka;
  scene.suture.length_m = l * (subject.nodes - 1);
  scene.suture.paper.node_mass_kg = 8e-5 * l;
  scene.suture.paper.bend_damping = scene.suture.paper.swivel_damping = 0.0;
  // The explicit models apply dampers before contacts in a step. This leaves an error of the axial force in proportion
  // to damping constant and time step, so the damping is just high enough for the strand's first axial mode (1e5 1/s).
  // It does not affect the equilibrium.
  scene.suture.paper.stretch_damping = 1e-5 * EA / l;
  set_bending(scene, 0.0);
  set_stretch(scene, EA);
  set_drag(scene, 300.0);
  const int bridge = subject.nodes - 1 - ka - kb, last = subject.nodes - 1;
  const Vec3 a0(-a, 0, 0), a1(a, 0, 0), b0(0, b, H), b1(0, -b, H), middle = 0.5 * (a1 + b0);
  const double half = 0.5 * (b0 - a1).norm(), leg = 0.5 * bridge * l;
  const Vec3 away = Vec3(b, a, 0).normalized();
  const Vec3 apex = middle + std::sqrt(std::max(0.0, leg * leg - half * half)) * away;
  const double z = 0.5 * (H + d);
  const auto bent = [](const Vec3& from, const Vec3& over, const Vec3& to, double share) -> Vec3 {
    return share < 0.5 ? Vec3(from + 2.0 * share * (over - from)) : Vec3(over + (2.0 * share - 1.0) * (to - over));
  };
  lay(scene, [&](double s) {
    const double k = s / l;
    if (k <= ka) return bent(a0, Vec3(0, 0, z + 0.1 * d), a1, k / ka);
    if (k < ka + bridge) return bent(a1, apex, b0, (k - ka) / bridge);
    return bent(b0, Vec3(0, 0, z - d - 0.1 * d), b1, (k - ka - bridge) / kb);
  });
  const auto fix = [&](int node, const Vec3& p) { scene.world.fixed.push_back({node, {p.x(), p.y(), p.z()}, {}}); };
  fix(0, a0), fix(ka, a1), fix(ka + bridge, b0), fix(last, b1);
  auto sim = build(scene);
  for (int k = 0; k < 400 && sim.diagnostics().finite; ++k) proceed(sim, no_hands());
  const auto x = sim.nodes_W();
  const auto at = [&](int i) -> const Vec3& { return x[static_cast<std::size_t>(i)]; };
  double strand = 0.0;
  for (int i = 0; i < ka; ++i) strand += (at(i + 1) - at(i)).norm();
  Crossing c;
  c.z_a = at(ka / 2).z();
  c.z_b = at(ka + bridge + kb / 2).z();
  c.tension_N = EA * (strand / (ka * l) - 1.0);
  const Vec3 e = (at(1) - at(0)).normalized(), f = (at(ka - 1) - at(ka)).normalized();
  c.force_N = c.tension_N * (e.z() + f.z());
  return c;
}

}  // namespace

Findings crossing_threads(const Subject& subject) {  // reference: balance of forces
  Findings all;
  for (const auto& row : reference_rows("06_crossing_threads.csv")) {
    // rows of another kind have a tension independent of length, which no model's thread has
    if (row.at("kind") != "elastic") continue;
    const auto c = crossing(subject, row);
    const auto at = "a, b " + row.at("a_m") + ", " + row.at("b_m") + ", T0 " + row.at("T0_A_N") + ", H " +
                    row.at("H_m") + ", EA " + row.at("EA_N");
    all.push_back(relative(at + ": height of A, m", number(row, "zA_m"), c.z_a, 0.01));
    all.push_back(relative(at + ": height of B, m", number(row, "zB_m"), c.z_b, 0.01));
    all.push_back(relative(at + ": contact force, N", number(row, "contact_force_N"), c.force_N, 0.01));
    all.push_back(relative(at + ": tension of A, N", number(row, "T_A_N"), c.tension_N, 0.01));
  }
  return all;
}

// reference: nonlinear boundary value problem, solved to 1e-9; bend length Lb = (B / w)^(1/3), B bending stiffness, w
// weight per length
Findings heavy_rod_lifted(const Subject& subject) {
  Findings all;
  for (const auto& row : reference_rows("06_heavy_rod_lifted_from_plane.csv")) {
    const double height = number(row, "H_over_Lb");
    auto scene = real_thread(subject, 1.0, 0.0);
    const bool rod = is_rod(scene);
    const double w = rod ? 8e-5 * 9.81 : 2.5 / 5.0 * 9.81, B = rod ? 4e-7 : 10.0 * (5.0 / 49.0) / 3.14159265358979;
    const double Lb = std::cbrt(B / w);
    const double per_m = scene.suture.paper.node_mass_kg / segment_m(scene);
    scene.suture.length_m = 5.0 * Lb;
    scene.suture.paper.node_mass_kg = per_m * segment_m(scene);
    set_bending(scene, B);
    set_drag(scene, rod ? 30.0 : 10.0);
    // a small damping constant, because explicit steps err in proportion to it; it does not affect the equilibrium
    scene.suture.paper.bend_damping *= 0.1;
    scene.suture.paper.stretch_damping *= 0.1;
    if (!rod) scene.hands.coupling_N_per_m = 2e4;
    scene.world.desk_height_m = 0.0;
    const double r = scene.suture.radius_m;
    lay(scene, [&](double s) { return Vec3(s, 0, r); });
    weigh(scene, w, 2);
    auto sim = build(scene);
    Tools tools = no_hands();
    tools[0] = {sim.nodes_W().front(), Vec3::Zero(), true};
    // elongation of the hand's spring, as a multiple of the bend length Lb
    const double give = number(row, "lift_force_over_wLb") * w / scene.hands.coupling_N_per_m;
    const double ahead = height + give;
    const int rise = rod ? 300 : 1000, ticks = rod ? 1200 : 4000;
    for (int k = 0; k < ticks && sim.diagnostics().finite; ++k) {
      tools[0].p_WT.z() = r + ahead * Lb * std::min(1.0, static_cast<double>(k + 1) / rise);
      tools[0].v_WT.z() = k < rise ? ahead * Lb / (rise * scene.time.tick_s) : 0.0;
      proceed(sim, tools);
    }
    const double force = -sim.hand(physics::Hand::kLeft).f_W.z() / (w * Lb);
    all.push_back(relative("H/Lb = " + row.at("H_over_Lb") + ": force/(w Lb)", number(row, "lift_force_over_wLb"),
                           sim.diagnostics().finite ? force : std::numeric_limits<double>::quiet_NaN(), 0.01));
  }
  return all;
}

}  // namespace ligature::validate
