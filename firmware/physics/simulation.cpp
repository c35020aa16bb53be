#include "firmware/physics/simulation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "firmware/physics/build.hpp"
#include "firmware/physics/internal_step.hpp"
#include "firmware/physics/obstacles.hpp"
#include "firmware/physics/paper_contact.hpp"
#include "firmware/physics/propagation.hpp"
#include "firmware/physics/rod/describe.hpp"
#include "firmware/physics/rod/rod_simulation.hpp"
#include "firmware/physics/stretch_spring.hpp"

namespace ligature::physics {
namespace {

constexpr double kOutOfRange = 1e9;  // m/s or m: beyond any thread; a run that gets there has diverged

V3<double> to_v3(const Vec3& a) noexcept { return {a.x(), a.y(), a.z()}; }
Vec3 to_vec3(const V3<double>& a) noexcept { return {a.x, a.y, a.z}; }

bool in_range(const V3<double>& a) noexcept {
  return std::abs(a.x) < kOutOfRange && std::abs(a.y) < kOutOfRange && std::abs(a.z) < kOutOfRange;
}

}  // namespace

struct Simulation::Impl {
  std::optional<rod::RodSimulation> rod;  // model "rod": everything below stays empty
  ThreadModel model;
  ThreadState initial, state, before;  // before: of the last finite tick
  InternalWorkspace work;
  InternalStep internal = nullptr;
  bool quadratic = false, forward = false, explicit_damping = false, has_limits = false;
  scene::ContactSolver contact_kind = scene::ContactSolver::kNone;
  ContactSolver contact;       // implicit
  PaperContact paper_contact;  // for comparison
  ObstacleCourse course;       // grippers and the frame's hooks
  LengthLimits limits;
  Coupling coupling;
  Grasp grasp;
  V3<double> gravity{};
  std::vector<std::pair<int, V3<double>>> loads;
  int substeps = 1;
  std::int64_t ticks = 0;
  double kinetic_J = 0.0, weight_J = 0.0;
  Lane3 rate_v;
  std::array<HandContact, 2> hands{};
  Diagnostics health{};
  std::vector<Vec3> nodes_W, velocities_W;  // made when asked for
  bool nodes_stale = true, velocities_stale = true;

  std::array<V3<double>, 2> hand_forces_N(const std::array<ToolInput, 2>& tools) noexcept;
  void add_external(const std::array<ToolInput, 2>& tools) noexcept;
  double integrate(const Lane3& v) noexcept;
  void step(const std::array<ToolInput, 2>& tools) noexcept;
  double fastest() const noexcept;
  Propagation condition(int node, bool other_holds) const noexcept;
  void remember() noexcept;
  bool check() noexcept;
  void publish() noexcept;
  void publish_contacts() noexcept;
  static void unpack(const Lane3& from, std::vector<Vec3>& to, bool& stale) noexcept;
  void restart() noexcept;
};

/// Force of each hand's coupling on its node, from the motion at the beginning of the step.
std::array<V3<double>, 2> Simulation::Impl::hand_forces_N(const std::array<ToolInput, 2>& tools) noexcept {
  std::array<V3<double>, 2> force{};
  for (std::size_t h = 0; h < 2; ++h) {
    const int node = grasp.node(static_cast<int>(h));
    if (node < 0) continue;
    force[h] = coupling_force_N(coupling, model.inverse_mass_per_kg[node], model.step_s, to_v3(tools[h].p_WT),
                                to_v3(tools[h].v_WT), state.p.at(node), state.v.at(node));
    hands[h].f_W -= (1.0 / substeps) * to_vec3(force[h]);
  }
  return force;
}

/// Drag, gravity, loads and hands: everything that is not the thread's own. Each acts on the motion that there was,
/// none on what another one is adding, so that no damping shifts a balance.
void Simulation::Impl::add_external(const std::array<ToolInput, 2>& tools) noexcept {
  const double dt = model.step_s;
  const auto force = hand_forces_N(tools);
  const Pack keep = splat(1.0 / (1.0 + dt * model.drag_per_s));
  const V3<Pack> fall{splat(dt * gravity.x), splat(dt * gravity.y), splat(dt * gravity.z)};
  for (int i = 0; i < model.nodes; i += kLanes) state.v.set(i, keep * state.v.pack(i) + model.free.pack(i) * fall);
  const auto push = [this, dt](int node, const V3<double>& f) {
    state.v.put(node, state.v.at(node) + (dt * model.inverse_mass_per_kg[node]) * f);
  };
  for (const auto& [node, force_N] : loads) push(node, force_N);
  for (std::size_t h = 0; h < 2; ++h)
    if (const int node = grasp.node(static_cast<int>(h)); node >= 0) push(node, force[h]);
}

/// Moves the nodes and sums up energies. @return the largest speed, m/s; NaN if any is.
double Simulation::Impl::integrate(const Lane3& v_W) noexcept {
  const Pack dt = splat(model.step_s);
  Pack fastest2 = splat(0.0), motion = splat(0.0), weight = splat(0.0);
  for (int i = 0; i < model.nodes; i += kLanes) {
    const V3<Pack> v = v_W.pack(i), p = state.p.pack(i) + dt * v;
    const Pack v2 = dot(v, v), free = model.free.pack(i);
    fastest2 = larger(fastest2, v2);
    motion += v2;
    weight += free * (gravity.x * p.x + gravity.y * p.y + gravity.z * p.z);
    state.p.set(i, p);
  }
  extend_last_node(state.p, model.nodes);
  kinetic_J = 0.5 * model.mass_kg * sum(motion);
  weight_J = -model.mass_kg * sum(weight);
  return std::sqrt(largest(fastest2));
}

void Simulation::Impl::step(const std::array<ToolInput, 2>& tools) noexcept {
  if (explicit_damping || forward) rate_v = state.v;  // same size: copies, does not allocate
  add_external(tools);
  internal(model, state, rate_v, work);
  if (has_limits) limits.warm_start(model, state, work.u);
  if (contact_kind == scene::ContactSolver::kImplicit) contact.solve(model, state);
  if (contact_kind == scene::ContactSolver::kPaper) paper_contact.solve(model, state);
  double speed = integrate(forward ? rate_v : state.v);
  if (has_limits && limits.enforce(model, state) > 0) speed = fastest();
  if (contact_kind == scene::ContactSolver::kImplicit) contact.moved(speed, model.step_s);
}

double Simulation::Impl::fastest() const noexcept {
  Pack fastest2 = splat(0.0);
  for (int i = 0; i < model.nodes; i += kLanes) fastest2 = larger(fastest2, dot(state.v.pack(i), state.v.pack(i)));
  return std::sqrt(largest(fastest2));
}

/// Keeps the state that a tick starts from. In packs: six calls of memcpy cost four times as much at 50 nodes.
void Simulation::Impl::remember() noexcept {
  for (int i = 0; i < model.nodes; i += kLanes) {
    before.p.set(i, state.p.pack(i));
    before.v.set(i, state.v.pack(i));
  }
  extend_last_node(before.p, model.nodes);
}

/// Finite and in range; if not, the state goes back to the last tick's and stays there.
bool Simulation::Impl::check() noexcept {
  if (kinetic_J < model.mass_kg * kOutOfRange * kOutOfRange && std::isfinite(weight_J)) return true;
  for (int i = 0; i < model.nodes; ++i) {
    if (in_range(state.p.at(i)) && in_range(state.v.at(i))) continue;
    health.finite = false;
    health.bad_node = i;
    health.bad_tick = ticks;
    hands = {};  // no force is the safe one to leave behind
    state = before;
    nodes_stale = velocities_stale = true;
    return false;
  }
  return true;
}

/// Nodes as vectors, for those who look; most ticks nobody does.
void Simulation::Impl::unpack(const Lane3& from, std::vector<Vec3>& to, bool& stale) noexcept {
  if (!stale) return;
  for (std::size_t i = 0; i < to.size(); ++i) to[i] = to_vec3(from.at(static_cast<int>(i)));
  stale = false;
}

void Simulation::Impl::publish_contacts() noexcept {
  health.contacts = 0;
  health.contact_cap_hit = false;
  health.min_gap_m = std::numeric_limits<double>::infinity();
  if (contact_kind == scene::ContactSolver::kImplicit) {
    const ContactReport& r = contact.report();
    health.contacts = r.active, health.contact_cap_hit = r.cap_hit, health.min_gap_m = r.min_gap_m;
  } else if (contact_kind == scene::ContactSolver::kPaper) {
    health.contacts = paper_contact.active();
    health.contact_cap_hit = paper_contact.cap_hit();
    health.min_gap_m = paper_contact.min_gap_m();
  }
}

/// Paper section IV: does the hand's force stay in the springs (A) or pass along a segment on its limit (B, C)?
Propagation Simulation::Impl::condition(int node, bool other_holds) const noexcept {
  if (!has_limits) return Propagation::kNone;
  const bool passes =
      (node > 0 && limits.passed_N(node - 1) != 0.0) || (node + 1 < model.nodes && limits.passed_N(node) != 0.0);
  if (!passes) return Propagation::kA;
  return other_holds ? Propagation::kC : Propagation::kB;
}

void Simulation::Impl::publish() noexcept {
  nodes_stale = velocities_stale = true;
  for (int h = 0; h < 2; ++h) {
    HandContact& c = hands[static_cast<std::size_t>(h)];
    c.node = grasp.node(h);
    if (c.node < 0) continue;
    c.p_WG = to_vec3(state.p.at(c.node));
    c.v_WG = to_vec3(state.v.at(c.node));
    c.condition = condition(c.node, grasp.node(1 - h) >= 0);
  }
  health.kinetic_J = kinetic_J;
  health.potential_J = weight_J + work.stretch_J + work.bend_J;
  health.max_stretch = work.max_strain;
  publish_contacts();
}

void Simulation::Impl::restart() noexcept {
  grasp.release_all();
  contact.forget();
  course.reset();
  limits.forget();
  hands = {};
  health = {};
  health.min_gap_m = std::numeric_limits<double>::infinity();
  ticks = 0;
  publish();
}

std::variant<Simulation, std::string> Simulation::make(const scene::Scene& scene) {
  if (scene.suture.model == scene::Model::kRod) {
    auto rod = rod::RodSimulation::make(scene);
    if (auto* why = std::get_if<std::string>(&rod)) return std::move(*why);
    auto impl = std::make_unique<Impl>();
    impl->rod.emplace(std::get<rod::RodSimulation>(std::move(rod)));
    return Simulation(std::move(impl));
  }
  auto built = build_thread(scene);
  if (auto* why = std::get_if<std::string>(&built)) return std::move(*why);
  auto& thread = std::get<BuiltThread>(built);
  auto impl = std::make_unique<Impl>();
  const auto n = static_cast<std::size_t>(thread.model.nodes);
  impl->internal = choose_internal_step(scene.suture);
  impl->contact_kind = scene.contact.solver;
  impl->has_limits = scene.hands.propagation;
  impl->quadratic = scene.suture.model == scene::Model::kPaper5;
  impl->forward = scene.suture.paper.integrator == scene::Integrator::kForward;
  impl->explicit_damping = scene.suture.paper.damping == scene::Damping::kExplicit;
  const ContactSettings contact = build_contact(scene, thread.model);
  if (impl->contact_kind == scene::ContactSolver::kImplicit) {
    impl->contact = ContactSolver(thread.model, contact);
    impl->course = ObstacleCourse(scene, thread.model, contact);
  }
  if (impl->contact_kind == scene::ContactSolver::kPaper)
    impl->paper_contact =
        PaperContact(thread.model, {{scene.contact.repulsion_N_per_m, scene.contact.repulsion_N_s_per_m},
                                    contact.stick,
                                    contact.slip,
                                    contact.skip,
                                    scene.contact.friction_cap});
  if (impl->has_limits) impl->limits = LengthLimits(thread.model, scene.hands.min_length, scene.hands.max_length);
  impl->coupling = {scene.hands.coupling_N_per_m, scene.hands.coupling_N_s_per_m};
  const auto& g = scene.world.gravity_m_per_s2;
  impl->gravity = {g[0], g[1], g[2]};
  for (const auto& load : scene.world.loads)
    impl->loads.emplace_back(load.node < 0 ? static_cast<int>(n) - 1 : load.node,
                             V3<double>{load.force_N[0], load.force_N[1], load.force_N[2]});
  impl->substeps = scene.time.substeps;
  impl->work = InternalWorkspace(thread.model.nodes);
  impl->rate_v = Lane3(thread.model.nodes);
  impl->nodes_W.resize(n);
  impl->velocities_W.resize(n);
  impl->initial = impl->state = impl->before = std::move(thread.initial);
  impl->model = std::move(thread.model);
  impl->restart();
  return Simulation(std::move(impl));
}

void Simulation::tick(const std::array<ToolInput, 2>& tools) noexcept {
  Impl& s = *impl_;
  if (s.rod) return s.rod->tick(tools);
  if (!s.health.finite) return;
  s.remember();
  s.grasp.update(tools, s.model, s.state);
  if (s.contact_kind == scene::ContactSolver::kImplicit)
    s.course.update(tools, s.grasp, s.model, s.state, s.contact.obstacles());
  for (HandContact& c : s.hands) c = {};
  bool fine = true;
  for (int k = 0; k < s.substeps && fine; ++k) {
    s.step(tools);
    fine = s.check();
  }
  ++s.ticks;
  if (fine) s.publish();
}

void Simulation::reset() noexcept {
  if (impl_->rod) return impl_->rod->reset();
  impl_->state = impl_->initial;
  impl_->restart();
}

bool Simulation::continue_from(const Simulation& other) noexcept {
  Impl& s = *impl_;
  const Impl& o = *other.impl_;
  if (s.rod.has_value() != o.rod.has_value()) return false;
  if (s.rod) return s.rod->continue_from(*o.rod);
  if (s.model.nodes != o.model.nodes) return false;
  s.restart();
  s.state = s.before = o.state;
  s.grasp = o.grasp;
  s.health = o.health;
  s.hands = o.hands;
  s.ticks = o.ticks;
  s.nodes_stale = s.velocities_stale = true;
  return true;
}

void Simulation::set_state(std::span<const Vec3> p_W, std::span<const Vec3> v_W) noexcept {
  Impl& s = *impl_;
  if (s.rod) return s.rod->set_state(p_W, v_W);
  for (int i = 0; i < s.model.nodes; ++i) {
    if (s.model.free[i] == 0.0) continue;
    const auto k = static_cast<std::size_t>(i);
    if (k < p_W.size()) s.state.p.put(i, to_v3(p_W[k]));
    s.state.v.put(i, k < v_W.size() ? to_v3(v_W[k]) : V3<double>{});
  }
  extend_last_node(s.state.p, s.model.nodes);
  s.restart();
}

std::span<const Vec3> Simulation::nodes_W() const noexcept {
  if (impl_->rod) return impl_->rod->nodes_W();
  Impl::unpack(impl_->state.p, impl_->nodes_W, impl_->nodes_stale);
  return impl_->nodes_W;
}
std::span<const Vec3> Simulation::velocities_W() const noexcept {
  if (impl_->rod) return impl_->rod->velocities_W();
  Impl::unpack(impl_->state.v, impl_->velocities_W, impl_->velocities_stale);
  return impl_->velocities_W;
}
void Simulation::describe(std::span<float> tension_N, std::span<float> turn_rad) const noexcept {
  if (impl_->rod) return rod::describe(impl_->rod->rod(), tension_N, turn_rad);
  const Impl& s = *impl_;
  std::ranges::fill(turn_rad, 0.0F);  // the paper's models have no twist
  float tension = 0.0F;
  for (std::size_t i = 0; i < tension_N.size(); ++i) {
    const int node = static_cast<int>(i);
    if (node + 1 < s.model.nodes) {
      const double strain = norm(s.state.p.at(node + 1) - s.state.p.at(node)) / s.model.rest_m - 1.0;
      tension = static_cast<float>(s.quadratic ? QuadraticStretchLaw::tension_N(strain, s.model.stretch_N)
                                               : LinearStretch::tension_N(strain, s.model.stretch_N));
    }
    tension_N[i] = tension;
  }
}
const HandContact& Simulation::hand(Hand h) const noexcept {
  return impl_->rod ? impl_->rod->hand(h) : impl_->hands[static_cast<std::size_t>(h)];
}
const Diagnostics& Simulation::diagnostics() const noexcept {
  return impl_->rod ? impl_->rod->diagnostics() : impl_->health;
}

Simulation::Simulation(std::unique_ptr<Impl> impl) noexcept : impl_(std::move(impl)) {}
Simulation::Simulation(const Simulation& other) : impl_(std::make_unique<Impl>(*other.impl_)) {}
Simulation& Simulation::operator=(const Simulation& other) {
  if (this != &other) impl_ = std::make_unique<Impl>(*other.impl_);
  return *this;
}
Simulation::Simulation(Simulation&&) noexcept = default;
Simulation& Simulation::operator=(Simulation&&) noexcept = default;
Simulation::~Simulation() = default;

}  // namespace ligature::physics
