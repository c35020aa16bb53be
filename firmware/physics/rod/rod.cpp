#include "firmware/physics/rod/rod.hpp"
#include "firmware/physics/rod/tuning.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace ligature::physics::rod {
namespace {

constexpr int kNodesInPiece = 500;  // assembling this many nodes takes at most TickTime::kPiece_ns
constexpr int kWindow = 1024;       // most nodes on which contacts are solved together

// Largest speed of a node relative to the mean velocity.
double stir(const std::vector<Vec>& v) noexcept {
  Vec mean{};
  for (const auto& each : v) mean += each;
  mean = (1.0 / static_cast<double>(v.size())) * mean;
  double most2 = 0.0;
  for (const auto& each : v) most2 = std::max(most2, dot(each - mean, each - mean));
  return std::sqrt(most2);
}

bool moves(const Body& body) noexcept { return dot(body.velocity, body.velocity) + dot(body.spin, body.spin) > 0.0; }

}  // namespace

Rod::Rod(const Material& material, const Numerics& numerics, const Parts& parts, int n, int body_count) {
  material_ = material;
  numerics_ = numerics;
  parts_ = parts;
  substep_ = pick(parts);
  near_m_ = 2.0 * material.radius_m * tuning.near_d;
  state_.resize(n);
  forces_.resize(n);
  solver_.resize(n);
  bodies.reserve(static_cast<std::size_t>(body_count));
  if (touches()) {
    metric_.reserve(n + 4, kWindow);
    contacts_.reserve(n, body_count, metric_.capacity());
    broad_.reserve(n, static_cast<int>(contacts_.pairs.capacity()));
    motion_.reserve(n);
    v_before_.assign(static_cast<std::size_t>(n), Vec{});
  }
  for (int i = 0; i < n; ++i) {
    state_.mesh.s[i] = material.length_m * i / (n - 1);
    state_.x[i] = make(state_.mesh.s[i], 0, 0);
  }
  if (parts.frames()) spin_.reserve(n);
  if (parts.turning) contacts_.reserve_turning();
  if (parts.adaptive) parts_.adaptive = refine_.start(material, 2.0 * material.radius_m, state_);
  moved();
}

// A copied vector loses its spare capacity, and a tick would then allocate. So: construct with capacity, then assign.
Rod::Rod(const Rod& other)
    : Rod(other.material_, other.numerics_, other.parts_, other.state_.nodes(),
          static_cast<int>(other.bodies.capacity())) {
  *this = other;
}

Rod& Rod::operator=(const Rod& other) {
  if (this == &other) return *this;
  const bool fits =
      parts_ == other.parts_ && state_.nodes() == other.state_.nodes() && bodies.capacity() == other.bodies.capacity();
  if (!fits) return *this = Rod(other);
  RodKept::operator=(other);
  RodNow::operator=({});
  RodCache::forget();
  return *this;
}

bool Rod::continue_from(const Rod& other) noexcept {
  if (state_.nodes() != other.state_.nodes() || parts_.adaptive != other.parts_.adaptive) return false;
  RodCourse::operator=(other);
  mesh_changed();
  if (parts_.frames() && other.parts_.frames()) {
    spin_ = other.spin_;
  } else if (parts_.frames()) {
    spin_.forget_born();
    spin_.start(material_, state_);
  } else if (other.parts_.frames()) {
    const auto born = other.spin_.born();
    for (std::size_t i = 0; i < born.size(); ++i) state_.rest_bend[i] -= born[i];
  }
  return true;
}

void Rod::spread(std::span<const double> curvature_per_m) {
  if (parts_.adaptive) refine_.start(material_, 2.0 * material_.radius_m, state_, curvature_per_m);
  moved();
}

void Rod::moved() noexcept {
  give_J_ = 0.0;
  alone_ = faded_ = false;  // kept_J_ no longer holds
  mesh_changed();
  if (parts_.frames()) spin_.start(material_, state_);
}

void Rod::mesh_changed() noexcept {
  for (auto& c : state_.mesh.clamp) c = Clamp::kFree;
  for (const Hold& hold : state_.slots()) {
    if (hold.node >= 0 && hold.directed) state_.mesh.clamp[hold.node] = Clamp::kClamped;
  }
  state_.mesh.rebuild(material_);
  contacts_.forget_matrix();
  RodCache::forget();
}

int Rod::add_hold(const Hold& hold) noexcept {
  int h = 0;
  while (h < state_.hold_count && state_.holds[h].node >= 0) ++h;
  if (h == kMaxHolds) return -1;
  state_.hold_count = std::max(state_.hold_count, h + 1);
  state_.holds[h] = hold;
  return h;
}

int Rod::support(int node, Vec p) noexcept { return add_hold({.node = node, .rigid = true, .target = p}); }

int Rod::clamp(int node, Vec p, Vec direction) noexcept {
  const int h = support(node, p);
  if (h < 0) return h;
  Hold& hold = state_.holds[h];
  hold.directed = true;
  hold.direction = unit(direction);
  if (parts_.twist) twist_.attach(state_, h);
  moved();
  return h;
}

int Rod::grip(int node, double stiffness_N_per_m, double damping_N_s_per_m, Vec tool, bool holds_roll,
              bool directed) noexcept {
  const int h = add_hold(
      {.node = node, .stiffness_N_per_m = stiffness_N_per_m, .damping_N_s_per_m = damping_N_s_per_m, .target = tool});
  if (h >= 0 && parts_.twist && holds_roll) {
    twist_.attach(state_, h);
    if (parts_.frames()) spin_.attach(state_, h);
  }
  if (h >= 0 && directed) {
    Hold& held = state_.holds[h];
    held.direction = tangent_at(state_, held);
    held.directed = true;
    mesh_changed();
  }
  return h;
}

void Rod::release(int hold) noexcept {
  Hold& h = state_.holds[hold];
  if (parts_.twist && h.holds_roll) twist_.detach(state_, hold);
  const bool directed = h.directed;
  h = Hold{};
  released_ = true;
  if (directed) mesh_changed();
}

void Rod::steer(int hold, Vec steer, Vec direction) noexcept {
  Hold& h = state_.holds[hold];
  h.steered = true;
  h.steer = steer;
  if (h.directed) h.direction = direction;
}

void Rod::fade() noexcept {
  refine_.slide(state_, numerics_.tick_s, alone_);
  if (alone_) {
    const Energy e = energy();
    const double now_J = all_J(e), lost_J = std::max(0.0, kept_J_ - now_J);
    const auto born = parts_.frames() ? spin_.born() : std::span<const Vec>{};
    kept_J_ = now_J + refine_.hold_back(material_, state_, born, tuning.fade_share * lost_J);
  }
  if (parts_.frames()) spin_.before_fading(state_, refine_.fade());
  refine_.fade_offsets(state_);
}

bool Rod::remesh() noexcept {
  if (!parts_.adaptive) return false;
  if (!std::exchange(faded_, false)) fade();
  if (!refine_.update(material_, state_, forces_, contacts_, bodies, work_)) return false;
  mesh_changed();
  remeshed_ = true;
  refine_.keep_stress(material_, state_);
  return true;
}

void Rod::tick() noexcept {
  std::array<Vec, kMaxHolds> goals;
  for (std::size_t h = 0; h < kMaxHolds; ++h) goals[h] = state_.holds[h].target;
  tick(goals);
}

Rod::HandSpeed Rod::set_hands(const std::array<Vec, kMaxHolds>& goals, std::array<Vec, kMaxHolds>& starts) noexcept {
  HandSpeed speed;
  for (std::size_t h = 0; h < kMaxHolds; ++h) {
    Hold& hold = state_.holds[h];
    starts[h] = hold.target;
    if (hold.node < 0) continue;
    hold.velocity = (1.0 / numerics_.tick_s) * (goals[h] - starts[h]);
    speed.fastest = std::max(speed.fastest, norm(hold.velocity));
    for (std::size_t k = 0; k < h; ++k) {
      const Hold& other = state_.holds[k];
      if (other.node >= 0) speed.apart = std::max(speed.apart, norm(hold.velocity - other.velocity));
    }
    ++speed.holds;
  }
  if (speed.holds == 1) speed.apart = speed.fastest;
  return speed;
}

void Rod::begin_tick(const HandSpeed& hands, const TimeLeft& left) noexcept {
  const bool was_alone = alone_;
  alone_ = hands.holds < 2 && hands.fastest == 0.0 && std::none_of(bodies.begin(), bodies.end(), moves);
  const double in_a_tick_d = numerics_.tick_s / (2.0 * material_.radius_m);
  const Situation now{.hand_d = in_a_tick_d * hands.fastest,
                      .node_d = touches() ? in_a_tick_d * motion_.fastest() : 0.0,
                      .released = std::exchange(released_, false),
                      .waits = patience_.waits()};
  const long budget = numerics_.budget(state_.nodes());
  const int last = report_.substeps;
  report_ = TickReport{.substeps = substeps_of(now, report_, budget, numerics_)};
  RodNow::operator=({});
  pace_m_per_s_ = 0.5 * hands.apart;
  // The clock is queried between forces, matrix and solution, each O(n): so the longest piece grows with n.
  const std::int64_t piece_ns = TickTime::kPiece_ns * std::max(1, state_.nodes() / kNodesInPiece);
  work_.start(budget, left, piece_ns);
  if (alone_ && !was_alone && parts_.adaptive) kept_J_ = all_J(energy());
  if (!mesh_held_) report_.remeshes += remesh();
  if (parts_.frames()) {
    twist_.carry(state_);
    spin_.update(material_, state_, forces_, numerics_.tick_s, remeshed_, !parts_.roll);
    remeshed_ = false;
  } else if (parts_.twist) {
    twist_.update(material_, state_, forces_);
  }
  if (touches()) {  // the caller may have changed velocities or bodies
    motion_.measure(state_.v.data());
    stir_m_per_s_ = stir(state_.v);
    contacts_.forget_bodies();
    if (needs_new_matrix(now, report_.substeps, last, numerics_)) contacts_.forget_matrix();
  }
}

void Rod::feel_hands(double ahead_s) noexcept {
  for (Hold& hold : state_.slots()) {
    if (hold.node < 0 || hold.rigid) continue;
    const int i = hold.node;
    hold.force = hold.stiffness_N_per_m * (state_.x[i] + ahead_s * state_.v[i] - hold.target) +
                 hold.damping_N_s_per_m * (state_.v[i] - hold.velocity);
  }
}

double Rod::all_J(const Energy& e) const noexcept {
  double sum = e.kinetic_J + e.stretch_J + e.bend_J + e.gravity_J + e.give_J + twist_energy_J();
  for (const Hold& hold : state_.slots()) {
    if (hold.node < 0) continue;
    const Vec off = state_.x[hold.node] - hold.target;
    sum += 0.5 * hold.stiffness_N_per_m * dot(off, off);
  }
  for (std::size_t i = 0; i < state_.x.size(); ++i) sum -= dot(state_.load[i], state_.x[i]);
  return sum;
}

void Rod::tick(const std::array<Vec, kMaxHolds>& goals, const TimeLeft& left) noexcept {
  std::array<Vec, kMaxHolds> starts;
  begin_tick(set_hands(goals, starts), left);
  const double dt = numerics_.tick_s / report_.substeps;
  bool moving = true;
  for (int k = 0; k < report_.substeps; ++k) {
    const double share = static_cast<double>(k + 1) / report_.substeps;
    for (int h = 0; h < state_.hold_count; ++h) {
      state_.holds[h].target = starts[h] + share * (goals[h] - starts[h]);
    }
    substep_index_ = k;
    braked_ = false;
    moving = moving && work_.time().allows() && (this->*substep_)(dt);
    if (!moving) report_.time_lost += 1.0 / report_.substeps;
  }
  if (measured_) give_J_ = contacts_.give_J(numerics_.contact_N_per_m, state_.v.data(), since_look_s_);
  if (alone_ && parts_.adaptive && !mesh_held_) fade(), faded_ = true;  // limited by what this tick has dissipated
  report_.work = work_.used();
  report_.cut_at = work_.time().cut_at();
  if (!braked_) feel_hands(0.0);
}

}  // namespace ligature::physics::rod
