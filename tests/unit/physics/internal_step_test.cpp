// The step of the internal forces: what implicit dampers may and may not do, for every model and any coefficient.
#include <gtest/gtest.h>

#include "firmware/physics/internal_step.hpp"
#include "tests/unit/physics/random_states.hpp"

namespace ligature::physics {
namespace {

using test::V;

struct Thread {
  ThreadModel m;
  ThreadState s;
  InternalWorkspace w;
};

Thread random_thread(int n, test::Random& random) {
  Thread t{.m = {}, .s = {Lane3(n), Lane3(n)}, .w = InternalWorkspace(n)};
  t.m.nodes = n, t.m.rest_m = 0.1, t.m.radius_m = 0.05, t.m.mass_kg = 0.05, t.m.step_s = 1e-3;
  t.m.inverse_mass_per_kg = t.m.free = t.m.segment = Lane(n);
  V p{0, 0, 0};
  for (int i = 0; i < n; ++i) {
    t.m.inverse_mass_per_kg[i] = 20.0, t.m.free[i] = 1.0, t.m.segment[i] = i + 1 < n;
    t.s.p.put(i, p), t.s.v.put(i, random.vector());
    p = p + random.vector(0.15);
  }
  extend_last_node(t.s.p, n);
  return t;
}

double kinetic(const Thread& t) {
  double e = 0;
  for (int i = 0; i < t.m.nodes; ++i) e += 0.5 * t.m.mass_kg * dot(t.s.v.at(i), t.s.v.at(i));
  return e;
}
void momenta(const Thread& t, V& linear, V& angular) {
  linear = angular = {0, 0, 0};
  for (int i = 0; i < t.m.nodes; ++i) {
    linear = linear + t.m.mass_kg * t.s.v.at(i);
    angular = angular + t.m.mass_kg * cross(t.s.p.at(i), t.s.v.at(i));
  }
}
scene::Suture suture(scene::Model model) {
  scene::Suture s;
  s.model = model;
  return s;
}
constexpr scene::Model kModels[] = {scene::Model::kPaper1, scene::Model::kPaper2, scene::Model::kPaper3,
                                    scene::Model::kPaper4, scene::Model::kPaper5};

TEST(InternalStep, ConservesBothMomentaInEveryModel) {
  test::Random random(1);
  for (const scene::Model model : kModels)
    for (int k = 0; k < 200; ++k) {
      Thread t = random_thread(2 + k % 40, random);
      t.m.stretch_N = 800, t.m.stretch_N_s_per_m = 1, t.m.bend_N_m = 10, t.m.bend_N_m_s = 0.05, t.m.swivel_N_s = 0.2;
      V p0, l0, p1, l1;
      momenta(t, p0, l0);
      const Lane3 before = t.s.v;
      choose_internal_step(suture(model))(t.m, t.s, before, t.w);
      momenta(t, p1, l1);
      double change = 0;
      for (int i = 0; i < t.m.nodes; ++i) change = std::max(change, norm(t.s.v.at(i) - before.at(i)));
      EXPECT_LE(norm(p1 - p0), 1e-12 * (1 + change)) << t.m.nodes << " nodes";
      EXPECT_LE(norm(l1 - l0), 1e-12 * (1 + change)) << t.m.nodes << " nodes";
    }
}

// Every damper alone and all together, coefficients over twelve decades: kinetic energy never grows.
TEST(InternalStep, ImplicitDampersNeverAddEnergyAtAnyCoefficient) {
  test::Random random(2);
  const auto step = choose_internal_step(suture(scene::Model::kPaper4));
  for (int k = 0; k < 2000; ++k) {
    Thread t = random_thread(2 + k % 40, random);
    t.m.stretch_N_s_per_m = random.log_in(1e-6, 1e6);
    t.m.bend_N_m_s = 0.05 * random.log_in(1e-6, 1e6);
    t.m.swivel_N_s = 0.2 * random.log_in(1e-6, 1e6);
    const double before = kinetic(t);
    step(t.m, t.s, t.s.v, t.w);
    EXPECT_LE(kinetic(t), before * (1 + 1e-9));
  }
}

TEST(InternalStep, ImplicitDampersLeaveRigidMotionAlone) {
  test::Random random(3);
  const auto step = choose_internal_step(suture(scene::Model::kPaper4));
  for (int k = 0; k < 500; ++k) {
    Thread t = random_thread(2 + k % 40, random);
    t.m.stretch_N_s_per_m = 1, t.m.bend_N_m_s = 0.05, t.m.swivel_N_s = 0.2;
    const V v = random.vector(), omega = random.vector();
    for (int i = 0; i < t.m.nodes; ++i) t.s.v.put(i, v + cross(omega, t.s.p.at(i)));
    const Lane3 before = t.s.v;
    step(t.m, t.s, before, t.w);
    for (int i = 0; i < t.m.nodes; ++i) EXPECT_LE(norm(t.s.v.at(i) - before.at(i)), 1e-11);
  }
}

// First order in the step: for small coefficients the implicit damper is the explicit one.
TEST(InternalStep, ImplicitDampingTendsToTheExplicitOneForSmallCoefficients) {
  test::Random random(4);
  scene::Suture as_printed = suture(scene::Model::kPaper4);
  as_printed.paper.damping = scene::Damping::kExplicit;
  Thread a = random_thread(20, random);
  a.m.stretch_N_s_per_m = 1e-6, a.m.bend_N_m_s = 1e-9, a.m.swivel_N_s = 1e-9;
  Thread b = a;
  const Lane3 before = a.s.v;
  choose_internal_step(suture(scene::Model::kPaper4))(a.m, a.s, before, a.w);
  choose_internal_step(as_printed)(b.m, b.s, before, b.w);
  for (int i = 0; i < 20; ++i) {
    const double change = norm(b.s.v.at(i) - before.at(i));
    EXPECT_LE(norm(a.s.v.at(i) - b.s.v.at(i)), 1e-4 * change + 1e-14);
  }
}

}  // namespace
}  // namespace ligature::physics
