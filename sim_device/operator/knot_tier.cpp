#include "sim_device/operator/knot_tier.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "sim_device/operator/primitives.hpp"
#include "sim_device/operator/springy_throw.hpp"

namespace ligature::sim {
namespace {

constexpr double kLook_s = 0.01;
constexpr int kMostAgain = 3;
constexpr double kTremor_m = 1e-4;  // tremor amplitude of a hand at rest, at hand scale

Vec3 vec(const scene::Vec& a) { return {a[0], a[1], a[2]}; }

double mass_kg(const scene::Suture& s) {
  return s.model == scene::Model::kRod ? s.rod.density_kg_per_m * s.length_m : s.paper.node_mass_kg * s.nodes;
}

Workplace workplace_of(const scene::Scene& scene, const Vec3& anchor_W) {
  const auto& s = scene.suture;
  const double g = vec(scene.world.gravity_m_per_s2).norm(), d = 2.0 * s.radius_m;
  const double EA = s.model == scene::Model::kRod ? s.rod.EA_N : s.paper.stretch_N;
  Workplace w;
  w.anchor_W = anchor_W;
  w.length_m = s.length_m;
  w.diameter_m = d;
  w.clearance_m = std::max(2.5 * d, 0.035 * s.length_m);
  const double weight_N_per_m = std::max(mass_kg(s) * g, 1e-9) / s.length_m;
  if (s.model == scene::Model::kRod) w.bend_length_m = std::cbrt(s.rod.EI_N_m2 / weight_N_per_m);
  w.tension_N = 0.0155 * EA + mass_kg(s) * g;
  w.speed_m_per_s = 0.1 * std::sqrt(std::max(g, 1.0) * s.length_m);
  return w;
}

/// Nodes that a chain needs so that its segments are not longer than Knot::longest_segment. The rod needs no minimum.
int least_nodes(const scene::Suture& s, const Knot& knot) {
  if (s.model == scene::Model::kRod) return 0;
  return 1 + static_cast<int>(std::ceil(s.length_m / (knot.longest_segment * 2.0 * s.radius_m) - 1e-9));
}

/// Number as text without trailing zeros: 4.5 as "4.5".
std::string shortest(double value) {
  std::array<char, 32> text{};
  return {text.data(), std::to_chars(text.data(), text.data() + text.size(), value).ptr};
}

}  // namespace

std::variant<KnotTier, std::string> KnotTier::make(const scene::Scene& scene, const std::string& name,
                                                   std::uint32_t seed) {
  const auto knot = name == kUntie.name ? std::optional(kUntie) : knot_named(name);
  if (!knot) return "knot: found \"" + name + "\", allowed " + knot_names();
  const double least_m = 2.0 * scene.suture.radius_m * knot->least_diameters;
  if (scene.suture.length_m < least_m) {
    return "suture.length_m: found " + shortest(scene.suture.length_m) + ", allowed " + shortest(least_m) +
           " or more for a " + std::string(knot->name) + " knot in a thread this thick";
  }
  if (const int least = least_nodes(scene.suture, *knot); scene.suture.nodes < least) {
    return "suture.nodes: found " + std::to_string(scene.suture.nodes) + ", allowed " + std::to_string(least) +
           " or more for a " + std::string(knot->name) + " knot in this thread: segments longer than " +
           shortest(knot->longest_segment) + " diameters do not go round its strands";
  }
  for (const auto& f : scene.world.fixed)
    if (f.node == 0) return KnotTier(scene, *knot, workplace_of(scene, vec(f.position_m)), seed);
  return "world.fixed: node 0 is not held; the operators tie a thread that hangs from its first node";
}

KnotTier::KnotTier(const scene::Scene& scene, const Knot& knot, const Workplace& place, std::uint32_t seed)
    : knot_(knot),
      place_(place),
      hands_{MovingHand(scene.time.tick_s), MovingHand(scene.time.tick_s)},
      tick_s_(scene.time.tick_s),
      dice_(seed) {
  place_.speed_m_per_s *= dice_.between(0.85, 1.15);
  const Vec3 home = vec(scene.hands.workspace_origin_m);
  for (std::size_t h = 0; h < 2; ++h) {
    const Vec3 start =
        home + dice_.vector(0.05 * place.length_m) + Vec3(h == 0 ? -0.1 : 0.1, -0.1, 0.0) * place.length_m;
    hands_[h].rest_at(start, place_.speed_m_per_s);
    const double size = kTremor_m * scene.hands.workspace_scale * dice_.between(0.5, 1.5);
    tremor_[h] = {Vec3(size, size, size), 2.0 * M_PI * (Vec3(10, 10, 10) + dice_.vector(2.0)),
                  Vec3(M_PI, M_PI, M_PI) + dice_.vector(M_PI)};
    wish_[h] = {start, Vec3::Zero(), false};
  }
  start_s_ = dice_.between(0.0, 0.5);
  lay_out(plan(knot, place_));
  ticks_a_look_ = std::max(1, static_cast<int>(std::lround(kLook_s / tick_s_)));
}

/// Makes `moves` the plan, with random short pauses as different persons would make.
void KnotTier::lay_out(Moves moves) {
  plan_.clear();
  next_ = 0;
  for (Move& m : moves) {
    plan_.push_back(std::move(m));
    if (dice_.between(0.0, 1.0) < 0.3) plan_.push_back(wait(dice_.between(0.0, 0.3)));
  }
}

void KnotTier::begin_again() {
  ++begun_again_;
  Moves moves{let_go(kRightHand), let_go(kLeftHand), hang_out()};
  place_.clearance_m *= dice_.between(0.8, 1.25);  // varied slightly, so that the next attempt differs
  if (is_springy(place_) && !knot_.throws.empty()) {
    append(moves, draw_straight());
    moves.push_back({"count the throws", [](const Look&) { return true; }});
    moves.back().then_plans = true;
  } else {
    append(moves, plan(knot_, place_, throws_tied_));
  }
  lay_out(std::move(moves));
}

/// Limits the pull of a hand that moves against the thread's force: above 0.4 of the force at which a knot is tight the
/// hand slows down, above 1.3 of it the hand yields.
void KnotTier::mind_the_pull(const Sight& sight) {
  constexpr double kFirm = 0.4, kMost = 1.3;  // fractions of a tight knot's pull
  // A limp thread is exempt: if it is thick, it is drawn tight with up to 4 times the pull of a tight knot
  // (wound_throw.cpp)
  if (!is_springy(place_)) return;
  for (std::size_t h = 0; h < 2; ++h) {
    MovingHand& hand = hands_[h];
    const Vec3& pull_N = sight.force_W_N[h];
    const double share = pull_N.norm() / place_.tension_N;
    hand.is_wary = share > kFirm && pull_N.dot(hand.goal_W - hand.p_W()) < 0.0;
    if (!hand.is_wary) continue;
    hand.pace = std::min(hand.pace, 0.15);
    if (share > kMost) hand.goal_W = hand.p_W() + 0.01 * place_.length_m * pull_N.normalized();
  }
}

void KnotTier::look(const Sight& sight) {
  thread_.look(sight.thread_W);
  for (int steps = 0; steps < 4 && !is_done();
       ++steps) {  // a move that is done at once is followed by the next one without delay
    Move& move = plan_[next_];
    const Look now{thread_, sight, place_, hands_, t_s_ - began_s_};
    const bool done = move.act(now);
    mind_the_pull(sight);
    if (!done && now.in_move_s < move.patience_s) return;
    if (!done) missed_.push_back(move.name);
    if (move.good && begun_again_ < kMostAgain && !move.good(now)) {
      begin_again();
    } else if (move.then_plans) {
      throws_tied_ = throws_seen(knot_, now).value_or(throws_tied_);
      lay_out(plan(knot_, place_, throws_tied_));
    } else {
      throws_tied_ += move.ends_throw;
      ++next_;
    }
    began_s_ = t_s_;
  }
}

const std::array<HandWish, 2>& KnotTier::tick(const Sight& sight) {
  t_s_ += tick_s_;
  if (t_s_ >= start_s_ && sight.thread_W.size() >= 2 && until_look_-- <= 0) {
    if (began_s_ == 0.0) began_s_ = t_s_;
    until_look_ = ticks_a_look_ - 1;
    look(sight);
  }
  for (std::size_t h = 0; h < 2; ++h) {
    hands_[h].tick();
    const Tremor& s = tremor_[h];
    const auto angle = s.rate_rad_per_s.array() * t_s_ + s.phase.array();
    wish_[h].p_W = hands_[h].p_W() + (s.amplitude_m.array() * angle.sin()).matrix();
    wish_[h].v_W = hands_[h].v_W() + (s.amplitude_m.array() * s.rate_rad_per_s.array() * angle.cos()).matrix();
    wish_[h].grip = hands_[h].grip;
  }
  return wish_;
}

}  // namespace ligature::sim
