// One time step of the thread's internal forces: implicit dampers are stable for every model and any coefficient.
#include <gtest/gtest.h>

#include "firmware/physics/paper/internal_step.hpp"
#include "firmware/physics/paper/propagation.hpp"
#include "tests/unit/physics/random_thread.hpp"

namespace ligature::physics {
namespace {

using test::kinetic_J;
using test::random_thread;
using test::Thread;
using test::V;

scene::Suture suture(scene::Model model, scene::SwivelDamper swivel = scene::SwivelDamper::kInternal) {
  scene::Suture s;
  s.model = model;
  s.paper.swivel = swivel;
  return s;
}
constexpr scene::SwivelDamper kSwivels[] = {scene::SwivelDamper::kInternal, scene::SwivelDamper::kPaper};
constexpr scene::Model kModels[] = {scene::Model::kPaper1, scene::Model::kPaper2, scene::Model::kPaper3,
                                    scene::Model::kPaper4, scene::Model::kPaper5};

TEST(InternalStep, ConservesBothMomentaInEveryModel) {
  test::Random random(1);
  for (const scene::Model model : kModels)
    for (int k = 0; k < 200; ++k) {
      Thread t = random_thread(2 + k % 40, random);
      t.m.stretch_N = 800, t.m.stretch_N_s_per_m = 1, t.m.bend_N_m = 10, t.m.bend_N_m_s = 0.05, t.m.swivel_N_s = 0.2;
      V p0, l0, p1, l1;
      test::momenta(t, p0, l0);
      const Lane3 before = t.s.v;
      choose_internal_step(suture(model))(t.m, t.s, before, t.w);
      test::momenta(t, p1, l1);
      double change = 0;
      for (int i = 0; i < t.m.nodes; ++i) change = std::max(change, norm(t.s.v.at(i) - before.at(i)));
      EXPECT_LE(norm(p1 - p0), 1e-12 * (1 + change)) << t.m.nodes << " nodes";
      EXPECT_LE(norm(l1 - l0), 1e-12 * (1 + change)) << t.m.nodes << " nodes";
    }
}

// With each damper by itself and with all together, with coefficients over twelve decades, the kinetic energy never
// grows.
TEST(InternalStep, ImplicitDampersNeverAddEnergyAtAnyCoefficient) {
  test::Random random(2);
  for (int k = 0; k < 4000; ++k) {
    const auto step = choose_internal_step(suture(scene::Model::kPaper4, kSwivels[k % 2]));
    Thread t = random_thread(2 + k % 40, random);
    t.m.stretch_N_s_per_m = random.log_in(1e-6, 1e6);
    t.m.bend_N_m_s = 0.05 * random.log_in(1e-6, 1e6);
    t.m.swivel_N_s = 0.2 * random.log_in(1e-6, 1e6);
    const double before = kinetic_J(t);
    step(t.m, t.s, t.s.v, t.w);
    EXPECT_LE(kinetic_J(t), before * (1 + 1e-9));
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

// For small coefficients the implicit damper equals the explicit one to first order in the time step.
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

// With the swivel damper only, in each model that has one: it never adds energy, and motion out of the bends' planes
// loses energy. A single thread may lose next to nothing, because its bends may hardly swing; so the mean loss of many
// threads is tested.
TEST(InternalStep, ASwivelDamperTakesEnergyFromWhatSwings) {
  test::Random random(5);
  constexpr int kThreads = 200;
  for (const auto model : {scene::Model::kPaper4, scene::Model::kPaper5})
    for (const auto swivel : kSwivels)
      for (const auto damping : {scene::Damping::kImplicit, scene::Damping::kExplicit}) {
        scene::Suture s = suture(model, swivel);
        s.paper.damping = damping;
        const auto step = choose_internal_step(s);
        // Short segments make the printed explicit law overshoot.
        const double smaller = damping == scene::Damping::kExplicit ? 1e-4 : 1.0;
        double lost = 0.0;
        for (int k = 0; k < kThreads; ++k) {
          Thread t = random_thread(4 + k % 40, random);
          t.m.swivel_N_s = 0.2 * smaller;
          const double before = kinetic_J(t);
          const Lane3 v = t.s.v;
          step(t.m, t.s, v, t.w);
          EXPECT_LE(kinetic_J(t), before * (1.0 + 1e-12));
          lost += 1.0 - kinetic_J(t) / before;
        }
        EXPECT_GT(lost / kThreads, 0.02 * smaller);
      }
}

// The explicit swivel damper on one bend is exactly the paper's equations (13)-(15), with the sign that damps.
TEST(InternalStep, ThePapersSwivelDamperBrakesEachEndAcrossThePlaneOfItsBend) {
  test::Random random(6);
  scene::Suture s = suture(scene::Model::kPaper4, scene::SwivelDamper::kPaper);
  s.paper.damping = scene::Damping::kExplicit;
  for (int k = 0; k < 500; ++k) {
    Thread t = random_thread(3, random);
    t.m.swivel_N_s = 0.2;
    const V l = t.s.p.at(1) - t.s.p.at(0), r = t.s.p.at(2) - t.s.p.at(1), axis = cross(l, r);
    if (norm(axis) < 1e-4) continue;
    const V a = (1.0 / norm(axis)) * axis;
    const Lane3 v = t.s.v;
    choose_internal_step(s)(t.m, t.s, v, t.w);
    const double dt_w = t.m.step_s / t.m.mass_kg;
    const V left = (-dt_w * 0.2 * dot(v.at(0) - v.at(1), a) / norm(l)) * a;
    const V right = (-dt_w * 0.2 * dot(v.at(2) - v.at(1), a) / norm(r)) * a;
    const double most = 1e-9 * (1.0 + norm(left) + norm(right));
    EXPECT_LE(norm(t.s.v.at(0) - v.at(0) - left), most);
    EXPECT_LE(norm(t.s.v.at(1) - v.at(1) + left + right), most);
    EXPECT_LE(norm(t.s.v.at(2) - v.at(2) - right), most);
  }
}

// Two nodes of mass m at rest, the spring between them under tension T: the velocity changes by dt T / m, divided by 1
// + 2 dt^2 (dT/dl) / m where the spring is implicit (model 5).
TEST(InternalStep, TheSpringIsLinearInModel4AndQuadraticInModel5) {
  test::Random random(7);
  for (const auto model : {scene::Model::kPaper4, scene::Model::kPaper5})
    for (const auto swivel : kSwivels)
      for (const auto damping : {scene::Damping::kImplicit, scene::Damping::kExplicit}) {
        scene::Suture s = suture(model, swivel);
        s.paper.damping = damping;
        for (int k = 0; k < 100; ++k) {
          Thread t = random_thread(2, random);
          t.m.stretch_N = 800.0;
          const double strain = random.in(-0.5, 0.5), dt = t.m.step_s, w = 1.0 / t.m.mass_kg;
          const V u = random.unit();
          t.s.p.put(1, t.s.p.at(0) + (t.m.rest_m * (1.0 + strain)) * u);
          extend_last_node(t.s.p, 2);
          t.s.v = Lane3(2);
          choose_internal_step(s)(t.m, t.s, Lane3(2), t.w);
          const bool quadratic = model == scene::Model::kPaper5;
          double wanted = dt * w * 800.0 * strain * (quadratic ? std::abs(strain) : 1.0);
          if (quadratic && damping == scene::Damping::kImplicit)
            wanted /= 1.0 + 2.0 * dt * dt * w * 2.0 * 800.0 * std::abs(strain) / t.m.rest_m;
          EXPECT_LE(norm(t.s.v.at(0) - wanted * u), 1e-9 * std::abs(wanted));
          EXPECT_LE(norm(t.s.v.at(1) + wanted * u), 1e-9 * std::abs(wanted));
        }
      }
}

// A segment that leaves its length limits by d in a step is brought back by d: the relative speed of its ends changes
// by d / dt, and the reported force is M d / dt^2, with M their reduced mass.
TEST(LengthLimits, PassTheForceThatBringsASegmentBack) {
  test::Random random(8);
  for (int k = 0; k < 500; ++k) {
    Thread t = random_thread(2, random);
    if (k % 2 == 0) t.m.inverse_mass_per_kg[0] = t.m.free[0] = 0.0;
    const double reduced_kg = 1.0 / (t.m.inverse_mass_per_kg[0] + t.m.inverse_mass_per_kg[1]);
    const bool longer = random.in(0.0, 1.0) < 0.5;
    const double beyond_m = t.m.rest_m * random.in(0.01, 0.3), limit_m = t.m.rest_m * (longer ? 1.1 : 0.9);
    const V u = random.unit();
    t.s.p.put(1, t.s.p.at(0) + (limit_m + (longer ? beyond_m : -beyond_m)) * u);
    extend_last_node(t.s.p, 2);
    const double rate = dot(t.s.v.at(1) - t.s.v.at(0), u), back_m = longer ? beyond_m : -beyond_m;
    LengthLimits limits(t.m, 0.9, 1.1);
    limits.enforce(t.m, t.s);
    EXPECT_NEAR(norm(t.s.p.at(1) - t.s.p.at(0)), limit_m, 1e-6 * t.m.rest_m);
    EXPECT_NEAR(dot(t.s.v.at(1) - t.s.v.at(0), u), rate - back_m / t.m.step_s, 1e-6 * beyond_m / t.m.step_s);
    const double force_N = reduced_kg * back_m / (t.m.step_s * t.m.step_s);
    EXPECT_NEAR(limits.passed_N(0), force_N, 1e-6 * std::abs(force_N));
  }
}

}  // namespace
}  // namespace ligature::physics
