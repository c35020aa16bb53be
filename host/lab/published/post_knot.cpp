#include "host/lab/published/post_knot.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "host/lab/published/knot_extent.hpp"
#include "host/lab/published/two_hands.hpp"

namespace ligature::published {
namespace {

using physics::rod::RodSimulation;
using validate::Vec3;

constexpr double kPi = std::numbers::pi;
constexpr double kPost_d = 20.0;  // radius of the post; the thread's centreline runs at kPost_d + 0.6
constexpr double kTail_d = 80.0, kSpeed_m_per_s = 0.05, kLoadSpeed_m_per_s = 0.005, kMost_N = 20.0;

/// The thread comes down along z, runs round the post, up again, and makes two half hitches about itself. Viewed along
/// +y; a negative y is in front.
std::vector<Vec3> sliding_curve(bool mirrored) {
  const double R = kPost_d + 0.6, side = 5.0, front = 3.0, high = 10.0;
  std::vector<Vec3> line{{0.0, 0.0, 140.0}, {0.0, 0.0, 0.0}};
  for (int k = 1; k <= 60; ++k) {
    const double a = kPi * k / 60.0;
    line.emplace_back(R * (1.0 - std::cos(a)), 0.0, -R * std::sin(a));
  }
  line.emplace_back(2.0 * R, 0.0, 8.0);
  double z = 40.0, f = front;
  for (int hitch = 0; hitch < 2; ++hitch, z += high + 8.0) {
    line.emplace_back(side, 0.0, z);
    line.emplace_back(side, 0.0, z + high);
    line.emplace_back(0.0, -f, z + high + 1.0);  // over the straight strand
    line.emplace_back(-side, 0.0, z + high);
    line.emplace_back(-side, 0.0, z + 0.4 * high);
    line.emplace_back(0.0, f, z + 0.4 * high);    // under it
    line.emplace_back(side, -f, z + 0.4 * high);  // over the hitch's own beginning
    line.emplace_back(2.0 * side, 0.0, z + 0.5 * high);
    if (mirrored) f = -f;
  }
  line.emplace_back(2.0 * side + kTail_d, 0.0, line.back().z());
  return rounded(line, 1.5, 0.5);
}

scene::Scene scene_of(const Subject& subject, const PostKnot& knot) {
  auto scene = validate::real_thread(subject.rod(200), 1.0, knot.friction);
  const double d = 2.0 * scene.suture.radius_m;
  scene.suture.rod.spacing = scene::Spacing::kAdaptive;
  if (knot.sets) {
    scene.suture.rod.GJ_N_m2 = 2.86e-7;
    scene.suture.rod.yield_strain = 0.1;
    scene.suture.rod.set_fraction = 0.35;
  }
  auto line = sliding_curve(knot.mirrored);
  for (auto& p : line) p *= d;
  lay_curve(scene, line);
  const double x = (kPost_d + 0.6) * d;
  scene.world.pegs.push_back({{x, -0.05, 0.0}, {x, 0.05, 0.0}, kPost_d * d});
  return scene;
}

/// Pulls the strands of the loop apart until a tail has slipped by 5 d. @return the largest tension
double strength_N(RodSimulation& sim, TwoHands& hands, double d) {
  const Vec3 out = Vec3::UnitX();
  const KnotExtent knot = extent_of(sim);
  if (knot.loop_1 - knot.loop_0 < 20.0 * d) return 0.0;  // no knot, or no loop that hands could take
  hands.take(place_at(sim, knot.loop_0 + 10.0 * d), place_at(sim, knot.loop_1 - 10.0 * d));
  double most = 0.0;
  for (int k = 0; k < 20000; ++k) {
    hands.tick(-kLoadSpeed_m_per_s * out, kLoadSpeed_m_per_s * out);
    const double pull = 0.5 * (hands.force_N(0, -out) + hands.force_N(1, out));
    const KnotExtent now = extent_of(sim);
    const double slip = std::max(knot.tail_0 - now.tail_0, now.tail_1 - knot.tail_1) / d;
    if (slip > 5.0 || pull > kMost_N) break;
    most = std::max(most, pull);
  }
  return most;
}

}  // namespace

PostResult tie_on_post(const Subject& subject, const PostKnot& knot) {
  const auto scene = scene_of(subject, knot);
  const double d = 2.0 * scene.suture.radius_m;
  auto sim = std::get<RodSimulation>(RodSimulation::make(scene));
  const std::string laid = knot_in(sim.nodes_W());
  TwoHands hands(sim, scene.time.tick_s);
  hands.take(sim.nodes_W().front(), sim.nodes_W().back());
  hands.rest(100);
  PostResult r;
  const std::array<Vec3, 2> out{Vec3::UnitZ(), Vec3::UnitX()};
  r.tied = hands.pull_to(knot.tying_N, out, kSpeed_m_per_s, 8000) && knot_in(sim.nodes_W()) == laid;
  hands.rest(300);
  const KnotExtent tight = extent_of(sim);
  hands.let_go();
  hands.rest(2000);
  const KnotExtent left = extent_of(sim);
  r.grown_d = ((left.tail_1 - left.tail_0) - (tight.tail_1 - tight.tail_0)) / d;
  r.normal_N = normal_force_N(sim);
  for (auto& body : sim.rod().bodies) body.p0 = body.p1 = physics::rod::make(1e6, 0.0, 0.0);  // the post is drawn out
  r.strength_N = strength_N(sim, hands, d);
  return r;
}

}  // namespace ligature::published
