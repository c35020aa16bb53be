#include "firmware/physics/rod/rod_simulation.hpp"

#include <cmath>
#include <limits>

#include "firmware/physics/rod/from_scene.hpp"

namespace ligature::physics::rod {
namespace {

constexpr double kOutOfRange = 1e9;  // m or m/s; larger values count as divergence
constexpr double kReach = 4.0;       // length of a gripper's capsule, along -y, in radii; its radius is the thread's

Vec vec(const Vec3& a) noexcept { return make(a.x(), a.y(), a.z()); }
Vec3 vec3(Vec a) noexcept { return {a[0], a[1], a[2]}; }

// The tool's axes as columns.
std::optional<Mat> axes_of(const ToolInput& tool) noexcept {
  if (!tool.R_WT) return std::nullopt;
  const Eigen::Matrix3d R = tool.R_WT->toRotationMatrix();
  return Mat{vec(R.col(0)), vec(R.col(1)), vec(R.col(2))};
}

Jaws jaws_of(const scene::Scene& scene) noexcept {
  const auto& h = scene.hands;
  const double slip_N = h.pinch_force_N ? 2.0 * scene.contact.friction * *h.pinch_force_N : 0.0;  // from both jaws
  return Jaws({h.pinch_width_m, slip_N, h.coupling_N_per_m, h.coupling_N_s_per_m});
}

}  // namespace

std::variant<RodSimulation, std::string> RodSimulation::make(const scene::Scene& scene) {
  auto built = rod_of(scene);
  if (auto* why = std::get_if<std::string>(&built)) return *why;
  return RodSimulation(scene, std::get<Rod>(std::move(built)));
}

RodSimulation::RodSimulation(const scene::Scene& scene, Rod rod)
    : Stage{rod,
            std::move(rod),
            scene.hands.reach_m.value_or(std::numeric_limits<double>::infinity()),
            scene.world.grippers_collide && parts_of(scene).world,
            0,
            {},
            {}} {
  jaws_ = {jaws_of(scene), jaws_of(scene)};
  gripper_body_ = static_cast<int>(rod_.bodies.size());
  if (grippers_) {
    const Body away{rod::make(1e6, 0, 0), rod::make(1e6, 0, 0), scene.suture.radius_m, Vec{}, scene.contact.friction};
    for (Rod* r : {&initial_, &rod_}) r->bodies.insert(r->bodies.end(), 2, away);
  }
  const std::size_t n = rod_.state().x.size();
  x_before_.resize(n);
  v_before_.resize(n);
  nodes_.resize(n);
  velocities_.resize(n);
  reset();
}

void RodSimulation::reset() noexcept {
  rod_ = initial_;
  for (auto& jaws : jaws_) jaws.forget();
  for (auto& closing : closing_) closing.forget();
  closed_ = {false, false};
  inside_ = {true, true};
  hands_ = {};
  health_ = {};
  ticks_ = 0;
  publish();
}

bool RodSimulation::continue_from(const RodSimulation& other) noexcept {
  if (!rod_.continue_from(other.rod_)) return false;
  HandsCourse::operator=(other);
  return true;
}

void RodSimulation::set_state(std::span<const Vec3> p_W, std::span<const Vec3> v_W) noexcept {
  reset();
  State& state = rod_.state();
  for (std::size_t i = 0; i < state.x.size(); ++i) {
    if (state.is_held(static_cast<int>(i))) continue;
    if (i < p_W.size()) state.x[i] = vec(p_W[i]);
    state.v[i] = i < v_W.size() ? vec(v_W[i]) : Vec{};
  }
  rod_.moved();
  publish();
}

int RodSimulation::nearest_free(Vec p) const noexcept {
  const State& state = rod_.state();
  double least2 = std::numeric_limits<double>::infinity();
  int best = -1;
  for (std::size_t i = 0; i < state.x.size(); ++i) {
    const Vec off = state.x[i] - p;
    const double d2 = dot(off, off);
    if (d2 < least2 && !state.is_held(static_cast<int>(i))) least2 = d2, best = static_cast<int>(i);
  }
  return best;
}

void RodSimulation::close_jaws(std::size_t h, const ToolInput& tool, const Mat* R_WT) noexcept {
  const Vec tip = vec(tool.p_WT);
  const int node = nearest_free(tip);
  if (node < 0 || norm(nearest_place(rod_.state(), node, tip).x - tip) > reach_m_) return;
  const Vec place = jaws_[h].would_hold(rod_, node, tip).x, velocity = rod_.state().v[node];
  const Vec tip_before = tip - rod_.numerics().tick_s * vec(tool.v_WT);
  closing_[h].start(vec3(place - tip_before), vec3(velocity) - tool.v_WT);
  jaws_[h].close(rod_, node, place, R_WT);
}

void RodSimulation::update_grasp(const std::array<ToolInput, 2>& tools) noexcept {
  for (std::size_t h = 0; h < 2; ++h) {
    const auto turned = axes_of(tools[h]);
    const Mat* const R_WT = turned ? &*turned : nullptr;
    if (tools[h].grip && !closed_[h]) {
      close_jaws(h, tools[h], R_WT);
    } else if (!tools[h].grip && jaws_[h].holds()) {
      jaws_[h].open(rod_);
      closing_[h].forget();
      inside_[h] = true;
    }
    closed_[h] = tools[h].grip;
    closing_[h].step(rod_.numerics().tick_s);
    jaws_[h].follow(rod_, vec(closing_[h].ease(tools[h]).p_WT), goals_, R_WT);
  }
}

// A gripper has no contacts while it holds the thread, and after its opening until it is clear of the thread.
void RodSimulation::update_grippers(const std::array<ToolInput, 2>& tools) noexcept {
  const double radius = rod_.material().radius_m;
  for (std::size_t h = 0; h < 2; ++h) {
    Body& body = rod_.bodies[static_cast<std::size_t>(gripper_body_) + h];
    const Vec tip = vec(tools[h].p_WT), tail = tip - rod::make(0, kReach * radius, 0);
    if (inside_[h]) {
      inside_[h] = false;
      for (const auto& x : rod_.state().x) inside_[h] |= norm(x - 0.5 * (tip + tail)) < (kReach + 4.0) * radius;
    }
    if (jaws_[h].holds() || inside_[h]) {
      body.p0 = body.p1 = rod::make(1e6, 0, 0);
      body.velocity = Vec{};
    } else {
      body.p0 = tip;
      body.p1 = tail;
      body.velocity = vec(tools[h].v_WT);
    }
  }
}

void RodSimulation::stop(int bad_node) noexcept {
  health_.finite = false;
  health_.bad_node = bad_node;
  health_.bad_tick = ticks_;
  hands_ = {};  // zero force is the safe final value
}

bool RodSimulation::is_finite() noexcept {
  const State& state = rod_.state();
  for (std::size_t i = 0; i < state.x.size(); ++i) {
    double most = 0.0;
    for (int k = 0; k < 3; ++k) most += std::abs(state.x[i][k]) + std::abs(state.v[i][k]);
    if (most < kOutOfRange) continue;  // a NaN does not pass
    stop(static_cast<int>(i));
    return false;
  }
  return true;
}

void RodSimulation::tick(const std::array<ToolInput, 2>& tools, const TimeLeft& left) noexcept {
  if (!health_.finite) return;
  State& state = rod_.state();
  x_before_ = state.x;  // same size, so no allocation
  v_before_ = state.v;
  for (int h = 0; h < state.hold_count; ++h) goals_[h] = state.holds[h].target;
  update_grasp(tools);
  if (grippers_) update_grippers(tools);
  rod_.tick(goals_, left);
  const bool good = is_finite();
  ++ticks_;
  if (good) {
    publish();
  } else {
    state.x = x_before_;
    state.v = v_before_;
  }
  rod_.tick_ended();
}

void RodSimulation::publish() noexcept {
  const State& state = rod_.state();
  for (std::size_t i = 0; i < state.x.size(); ++i) {
    nodes_[i] = vec3(state.x[i]);
    velocities_[i] = vec3(state.v[i]);
  }
  for (std::size_t h = 0; h < 2; ++h) {
    HandContact& c = hands_[h];
    c = {};
    if (!jaws_[h].holds()) continue;
    const Hold& hold = state.holds[jaws_[h].middle(rod_)];
    c.node = hold.node;
    c.p_WG = vec3(jaws_[h].place(rod_)) - closing_[h].offset_m();  // the coupling computes the hand's force from these
    c.v_WG = vec3(jaws_[h].velocity(rod_)) - closing_[h].rate_m_per_s();
    c.f_W = vec3(jaws_[h].force(rod_));
  }
  const Energy e = rod_.energy();
  const TickReport& r = rod_.report();
  health_.kinetic_J = e.kinetic_J;
  health_.potential_J = e.gravity_J + e.stretch_J + e.bend_J + e.give_J + rod_.twist_energy_J();
  health_.max_stretch = e.max_strain;
  health_.min_gap_m = r.min_gap_m < 1e8 ? r.min_gap_m : std::numeric_limits<double>::infinity();
  health_.contacts = r.contacts;
  health_.contact_cap_hit = r.rows_left_out > 0;
  health_.time_lost = r.time_lost;
  health_.cut_at = r.cut_at;
  health_.work = r.work;
  health_.end = r.cut_at >= 0 ? TickEnd::kClock : r.time_lost > 0.0 ? TickEnd::kWork : TickEnd::kWhole;
  health_.degradation = r.time_lost > 0.0     ? Degradation::kMotion
                        : r.rows_left_out > 0 ? Degradation::kContacts
                        : r.cut_short > 0     ? Degradation::kIterations
                                              : Degradation::kNone;
}

}  // namespace ligature::physics::rod
