#include "firmware/physics/paper/paper_simulation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "firmware/physics/paper/build.hpp"
#include "firmware/physics/paper/stretch_spring.hpp"

namespace ligature::physics {
namespace {

constexpr std::int64_t kSubstep_ns = 400'000;  // longest time of a substep, the piece of work between clock queries
constexpr double kOutOfRange = 1e9;            // m/s or m; larger values count as divergence

V3<double> to_v3(const Vec3& a) noexcept { return {a.x(), a.y(), a.z()}; }
V3<double> to_v3(const scene::Vec& a) noexcept { return {a[0], a[1], a[2]}; }
Vec3 to_vec3(const V3<double>& a) noexcept { return {a.x, a.y, a.z}; }

bool in_range(const V3<double>& a) noexcept {
  return std::abs(a.x) < kOutOfRange && std::abs(a.y) < kOutOfRange && std::abs(a.z) < kOutOfRange;
}

}  // namespace

/// Force of each hand's coupling on the held node, computed from the state at the beginning of the step.
std::array<V3<double>, 2> PaperSimulation::hand_forces_N(const std::array<ToolInput, 2>& tools) noexcept {
  std::array<V3<double>, 2> force{};
  for (std::size_t h = 0; h < 2; ++h) {
    const int node = grasp_.node(static_cast<int>(h));
    if (node < 0) continue;
    force[h] = coupling_force_N(coupling_, model_.inverse_mass_per_kg[node], model_.step_s, to_v3(tools[h].p_WT),
                                to_v3(tools[h].v_WT), state_.p.at(node), state_.v.at(node));
    hands_[h].f_W -= (1.0 / substeps_) * to_vec3(force[h]);
  }
  return force;
}

/// Adds external forces: drag, gravity, loads and hands. Drag and the hands' dampers use the velocities from before
/// this step's forces, so that damping cannot shift an equilibrium.
void PaperSimulation::add_external(const std::array<ToolInput, 2>& tools) noexcept {
  const double dt = model_.step_s;
  const auto force = hand_forces_N(tools);
  const Pack keep = splat(1.0 / (1.0 + dt * model_.drag_per_s));
  const V3<Pack> fall{splat(dt * gravity_.x), splat(dt * gravity_.y), splat(dt * gravity_.z)};
  for (int i = 0; i < model_.nodes; i += kLanes) state_.v.set(i, keep * state_.v.pack(i) + model_.free.pack(i) * fall);
  const auto push = [this, dt](int node, const V3<double>& f) {
    state_.v.put(node, state_.v.at(node) + (dt * model_.inverse_mass_per_kg[node]) * f);
  };
  for (const auto& [node, force_N] : loads_) push(node, force_N);
  for (std::size_t h = 0; h < 2; ++h)
    if (const int node = grasp_.node(static_cast<int>(h)); node >= 0) push(node, force[h]);
}

/// Moves the nodes and sums up energies. @return the largest speed, m/s; NaN if any speed is NaN.
double PaperSimulation::integrate(const Lane3& v_W) noexcept {
  const Pack dt = splat(model_.step_s);
  Pack fastest2 = splat(0.0), motion = splat(0.0), weight = splat(0.0);
  for (int i = 0; i < model_.nodes; i += kLanes) {
    const V3<Pack> v = v_W.pack(i), p = state_.p.pack(i) + dt * v;
    const Pack v2 = dot(v, v), free = model_.free.pack(i);
    fastest2 = larger(fastest2, v2);
    motion += v2;
    weight += free * (gravity_.x * p.x + gravity_.y * p.y + gravity_.z * p.z);
    state_.p.set(i, p);
  }
  extend_last_node(state_.p, model_.nodes);
  kinetic_J_ = 0.5 * model_.mass_kg * sum(motion);
  weight_J_ = -model_.mass_kg * sum(weight);
  return std::sqrt(largest(fastest2));
}

void PaperSimulation::step(const std::array<ToolInput, 2>& tools) noexcept {
  if (explicit_damping_ || forward_) rate_v_ = state_.v;  // same size, so no allocation
  add_external(tools);
  if (has_limits_) limits_.warm_start(model_, state_);
  internal_(model_, state_, rate_v_, work_);
  if (contact_kind_ == scene::ContactSolver::kImplicit) contact_.solve(model_, state_);
  if (contact_kind_ == scene::ContactSolver::kPaper) paper_contact_.solve(model_, state_);
  double speed = integrate(forward_ ? rate_v_ : state_.v);
  if (has_limits_ && limits_.enforce(model_, state_) > 0) speed = fastest();
  if (contact_kind_ == scene::ContactSolver::kImplicit) contact_.moved(speed, model_.step_s);
}

double PaperSimulation::fastest() const noexcept {
  Pack fastest2 = splat(0.0);
  for (int i = 0; i < model_.nodes; i += kLanes) fastest2 = larger(fastest2, dot(state_.v.pack(i), state_.v.pack(i)));
  return std::sqrt(largest(fastest2));
}

/// Stores the state at the start of a tick. Copies it in packs of four numbers; six calls of memcpy would take four
/// times as long at 50 nodes.
void PaperSimulation::remember() noexcept {
  for (int i = 0; i < model_.nodes; i += kLanes) {
    before_.p.set(i, state_.p.pack(i));
    before_.v.set(i, state_.v.pack(i));
  }
  extend_last_node(before_.p, model_.nodes);
}

void PaperSimulation::stop(int bad_node) noexcept {
  health_.finite = false;
  health_.bad_node = bad_node;
  health_.bad_tick = ticks_;
  hands_ = {};  // zero force is the safe final value
}

/// Is the state finite and in range? If not, the thread is put back to the start of the tick and frozen.
bool PaperSimulation::check() noexcept {
  if (kinetic_J_ < model_.mass_kg * kOutOfRange * kOutOfRange && std::isfinite(weight_J_)) return true;
  for (int i = 0; i < model_.nodes; ++i) {
    if (in_range(state_.p.at(i)) && in_range(state_.v.at(i))) continue;
    stop(i);
    state_ = before_;
    nodes_stale_ = velocities_stale_ = true;
    return false;
  }
  return true;
}

/// Converts packed nodes to vectors if they have changed since the last call.
std::span<const Vec3> PaperSimulation::unpacked(const Lane3& from, std::vector<Vec3>& to, bool& stale) noexcept {
  for (std::size_t i = 0; stale && i < to.size(); ++i) to[i] = to_vec3(from.at(static_cast<int>(i)));
  stale = false;
  return to;
}

void PaperSimulation::publish_contacts() noexcept {
  health_.contacts = 0;
  health_.contact_cap_hit = false;
  health_.min_gap_m = std::numeric_limits<double>::infinity();
  if (contact_kind_ == scene::ContactSolver::kImplicit) {
    const ContactReport& r = contact_.report();
    health_.contacts = r.active, health_.contact_cap_hit = r.cap_hit, health_.min_gap_m = r.min_gap_m;
  } else if (contact_kind_ == scene::ContactSolver::kPaper) {
    health_.contacts = paper_contact_.active();
    health_.contact_cap_hit = paper_contact_.cap_hit();
    health_.min_gap_m = paper_contact_.min_gap_m();
  }
}

/// Condition of the paper's section IV for a hand that holds `node`. A: only springs transmit the hand's force. B: a
/// neighbouring segment is at its length limit and transmits the force. C: as B, and the other hand holds the thread
/// too.
Propagation PaperSimulation::condition(int node, bool other_holds) const noexcept {
  if (!has_limits_) return Propagation::kNone;
  const bool passes =
      (node > 0 && limits_.passed_N(node - 1) != 0.0) || (node + 1 < model_.nodes && limits_.passed_N(node) != 0.0);
  if (!passes) return Propagation::kA;
  return other_holds ? Propagation::kC : Propagation::kB;
}

void PaperSimulation::publish() noexcept {
  nodes_stale_ = velocities_stale_ = true;
  for (int h = 0; h < 2; ++h) {
    HandContact& c = hands_[static_cast<std::size_t>(h)];
    c.node = grasp_.node(h);
    c.condition = c.node < 0 ? Propagation::kNone : condition(c.node, grasp_.node(1 - h) >= 0);
    if (c.node < 0) continue;
    c.p_WG = to_vec3(state_.p.at(c.node)) - grasp_.closing(h).offset_m();
    c.v_WG = to_vec3(state_.v.at(c.node)) - grasp_.closing(h).rate_m_per_s();
  }
  health_.kinetic_J = kinetic_J_;
  health_.potential_J = weight_J_ + work_.stretch_J + work_.bend_J;
  health_.max_stretch = work_.max_strain;
  publish_contacts();
}

void PaperSimulation::restart() noexcept {
  grasp_.release_all();
  contact_.forget();
  course_.reset();
  limits_.forget();
  paper_contact_.forget();
  kinetic_J_ = weight_J_ = 0.0;  // not computed yet; published like this if the first tick has no time for a substep
  work_.stretch_J = work_.bend_J = work_.max_strain = 0.0;
  hands_ = {};
  health_ = {};
  health_.min_gap_m = std::numeric_limits<double>::infinity();
  ticks_ = 0;
  publish();
}

void PaperSimulation::set_contact(const scene::Scene& scene) {
  const ContactSettings contact = build_contact(scene, model_);
  contact_kind_ = scene.contact.solver;
  if (contact_kind_ == scene::ContactSolver::kImplicit) {
    contact_ = ContactSolver(model_, contact);
    course_ = ObstacleCourse(scene, model_, contact);
  }
  if (contact_kind_ == scene::ContactSolver::kPaper)
    paper_contact_ = PaperContact(model_, {{scene.contact.repulsion_N_per_m, scene.contact.repulsion_N_s_per_m},
                                           contact.stick,
                                           contact.slip,
                                           contact.skip,
                                           scene.contact.friction_cap});
}

std::variant<PaperSimulation, std::string> PaperSimulation::make(const scene::Scene& scene) {
  if (scene.contact.solver == scene::ContactSolver::kImplicit) {
    if (auto why = ObstacleCourse::objection(scene); !why.empty()) return why;
  }
  auto built = build_thread(scene);
  if (auto* why = std::get_if<std::string>(&built)) return std::move(*why);
  auto& thread = std::get<BuiltThread>(built);
  const int n = thread.model.nodes;
  PaperSimulation s;
  s.model_ = std::move(thread.model);
  s.initial_ = s.state_ = s.before_ = std::move(thread.initial);
  s.internal_ = choose_internal_step(scene.suture);
  s.kind_ = scene.suture.model;
  s.swivel_ = scene.suture.paper.swivel;
  s.has_limits_ = scene.hands.propagation;
  s.forward_ = scene.suture.paper.integrator == scene::Integrator::kForward;
  s.explicit_damping_ = scene.suture.paper.damping == scene::Damping::kExplicit;
  s.set_contact(scene);
  if (s.has_limits_) s.limits_ = LengthLimits(s.model_, scene.hands.min_length, scene.hands.max_length);
  s.coupling_ = {scene.hands.coupling_N_per_m, scene.hands.coupling_N_s_per_m};
  s.gravity_ = to_v3(scene.world.gravity_m_per_s2);
  for (const auto& load : scene.world.loads)
    s.loads_.emplace_back(load.node < 0 ? n - 1 : load.node, to_v3(load.force_N));
  s.substeps_ = scene.time.substeps;
  s.tick_s_ = scene.time.tick_s;
  s.grasp_ = Grasp(scene.hands.reach_m.value_or(std::numeric_limits<double>::infinity()));
  s.work_ = InternalWorkspace(n);
  s.rate_v_ = Lane3(n);
  s.nodes_W_.resize(static_cast<std::size_t>(n));
  s.velocities_W_.resize(static_cast<std::size_t>(n));
  s.restart();
  return s;
}

void PaperSimulation::tick(const std::array<ToolInput, 2>& tools, const TimeLeft& left) noexcept {
  if (!health_.finite) return;
  time_.start(left, kSubstep_ns);
  remember();
  grasp_.update(tools, model_, state_);
  const std::array<ToolInput, 2> eased{grasp_.closing(0).ease(tools[0]), grasp_.closing(1).ease(tools[1])};
  if (contact_kind_ == scene::ContactSolver::kImplicit)
    course_.update(tools, grasp_, model_, state_, contact_.obstacles());
  const std::array<Vec3, 2> felt{hands_[0].f_W, hands_[1].f_W};
  for (HandContact& c : hands_) c = {};
  bool fine = true;
  int done = 0;
  for (; done < substeps_ && fine && time_.allows(); ++done) {
    step(eased);
    fine = check();
  }
  ++ticks_;
  grasp_.step(tick_s_);
  health_.time_lost = time_.is_over() ? 1.0 - static_cast<double>(done) / substeps_ : 0.0;
  health_.degradation = time_.is_over() ? Degradation::kMotion : Degradation::kNone;
  health_.end = time_.is_over() ? TickEnd::kClock : TickEnd::kWhole;
  health_.cut_at = time_.cut_at();
  if (fine) {
    if (time_.is_over()) feel_what_was_done(done, felt);
    publish();
  }
  time_.end();
}

/// Sets the hand forces of a tick that ended early: the mean over the substeps that were done, or the last tick's
/// forces if there were none.
void PaperSimulation::feel_what_was_done(int substeps, const std::array<Vec3, 2>& before) noexcept {
  for (std::size_t h = 0; h < 2; ++h) {
    if (substeps > 0) {
      hands_[h].f_W *= static_cast<double>(substeps_) / substeps;
    } else if (grasp_.node(static_cast<int>(h)) >= 0) {
      hands_[h].f_W = before[h];
    }
  }
}

void PaperSimulation::describe(std::span<float> tension_N, std::span<float> turn_rad) const noexcept {
  std::ranges::fill(turn_rad, 0.0F);  // the paper's models have no twist
  float tension = 0.0F;
  for (std::size_t i = 0; i < tension_N.size(); ++i) {
    const int node = static_cast<int>(i);
    if (node + 1 < model_.nodes) {
      const double strain = norm(state_.p.at(node + 1) - state_.p.at(node)) / model_.rest_m - 1.0;
      const double spring_N = kind_ == scene::Model::kPaper5 ? QuadraticStretchLaw::tension_N(strain, model_.stretch_N)
                                                             : LinearStretch::tension_N(strain, model_.stretch_N);
      tension = static_cast<float>(spring_N + (has_limits_ ? limits_.passed_N(node) : 0.0));
    }
    tension_N[i] = tension;
  }
}

std::size_t PaperSimulation::contacts(std::span<ContactPoint> out) const noexcept {
  return contact_kind_ == scene::ContactSolver::kImplicit ? contact_.points(state_, model_.step_s, out) : 0;
}

void PaperSimulation::reset() noexcept {
  state_ = initial_;
  restart();
}

bool PaperSimulation::continue_from(const PaperSimulation& other) noexcept {
  if (model_.nodes != other.model_.nodes) return false;
  restart();
  state_ = before_ = other.state_;
  grasp_ = other.grasp_;
  health_ = other.health_;
  hands_ = other.hands_;
  ticks_ = other.ticks_;
  nodes_stale_ = velocities_stale_ = true;
  return true;
}

void PaperSimulation::set_state(std::span<const Vec3> p_W, std::span<const Vec3> v_W) noexcept {
  for (int i = 0; i < model_.nodes; ++i) {
    if (model_.free[i] == 0.0) continue;
    const auto k = static_cast<std::size_t>(i);
    if (k < p_W.size()) state_.p.put(i, to_v3(p_W[k]));
    state_.v.put(i, k < v_W.size() ? to_v3(v_W[k]) : V3<double>{});
  }
  extend_last_node(state_.p, model_.nodes);
  restart();
}

}  // namespace ligature::physics
