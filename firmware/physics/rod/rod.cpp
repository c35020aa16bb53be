#include "firmware/physics/rod/rod.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace ligature::physics::rod {
namespace {

constexpr unsigned kTwist = 1, kContact = 2, kFriction = 4, kWorld = 8;
constexpr int kWindow = 512;

}  // namespace

Rod::Rod(const Material& material, const Numerics& numerics, const Parts& parts, int n, int body_count)
    : material_(material), numerics_(numerics), parts_(parts), substep_(pick(parts)) {
  state_.resize(n);
  forces_.resize(n);
  solver_.resize(n);
  bodies.reserve(static_cast<std::size_t>(body_count));
  if (parts.contact || parts.world) {
    metric_.reserve(n, kWindow);
    contacts_.reserve(n, body_count, metric_.capacity());
    broad_.reserve(n, static_cast<int>(contacts_.pairs.capacity()));
  }
  for (int i = 0; i < n; ++i) {
    state_.mesh.s[static_cast<std::size_t>(i)] = material.length_m * i / (n - 1);
    state_.x[static_cast<std::size_t>(i)] = make(state_.mesh.s[static_cast<std::size_t>(i)], 0, 0);
  }
  if (parts.adaptive) parts_.adaptive = refine_.start(material, 2.0 * material.radius_m, state_);
  moved();
}

// Copies of vectors have no spare room; ours must, or a tick would allocate.
Rod::Rod(const Rod& other)
    : Rod(other.material_, other.numerics_, other.parts_, other.state_.nodes(),
          static_cast<int>(other.bodies.capacity())) {
  *this = other;
}

Rod& Rod::operator=(const Rod& other) {
  if (this == &other) return *this;
  gravity = other.gravity;
  floor_m = other.floor_m, floor_friction = other.floor_friction, has_floor = other.has_floor;
  bodies.reserve(other.bodies.capacity());
  bodies = other.bodies;
  material_ = other.material_, numerics_ = other.numerics_, parts_ = other.parts_;
  state_ = other.state_;
  forces_ = other.forces_;
  contacts_ = other.contacts_;
  twist_ = other.twist_;
  refine_ = other.refine_;
  report_ = other.report_;
  substep_ = other.substep_;
  solver_.resize(state_.nodes());
  metric_.invalidate();
  stale_ = true;
  return *this;
}

bool Rod::continue_from(const Rod& other) noexcept {
  if (state_.nodes() != other.state_.nodes()) return false;
  state_ = other.state_;
  forces_ = other.forces_;
  twist_ = other.twist_;
  refine_ = other.refine_;
  report_ = other.report_;
  moved();
  return true;
}

void Rod::moved() noexcept {
  for (auto& c : state_.mesh.clamp) c = Clamp::kFree;
  for (int h = 0; h < state_.hold_count; ++h) {
    const Hold& hold = state_.holds[static_cast<std::size_t>(h)];
    if (hold.node >= 0 && hold.directed) state_.mesh.clamp[static_cast<std::size_t>(hold.node)] = Clamp::kClamped;
  }
  state_.mesh.rebuild(material_);
  metric_.invalidate();
  stale_ = true;
}

int Rod::add_hold(const Hold& hold) noexcept {
  int h = 0;
  while (h < state_.hold_count && state_.holds[static_cast<std::size_t>(h)].node >= 0) ++h;
  if (h == kMaxHolds) return -1;
  state_.hold_count = std::max(state_.hold_count, h + 1);
  state_.holds[static_cast<std::size_t>(h)] = hold;
  return h;
}

int Rod::support(int node, Vec p) noexcept {
  Hold hold;
  hold.node = node;
  hold.rigid = true;
  hold.target = p;
  return add_hold(hold);
}

int Rod::clamp(int node, Vec p, Vec direction) noexcept {
  const int h = support(node, p);
  if (h < 0) return h;
  Hold& hold = state_.holds[static_cast<std::size_t>(h)];
  hold.directed = true;
  hold.direction = (1.0 / norm(direction)) * direction;
  if (parts_.twist) twist_.attach(state_, h);
  moved();
  return h;
}

int Rod::grip(int node, double stiffness_N_per_m, double damping_N_s_per_m, Vec tool) noexcept {
  Hold hold;
  hold.node = node;
  hold.stiffness_N_per_m = stiffness_N_per_m;
  hold.damping_N_s_per_m = damping_N_s_per_m;
  hold.target = tool;
  const int h = add_hold(hold);
  if (h >= 0 && parts_.twist) twist_.attach(state_, h);
  return h;
}

void Rod::release(int hold) noexcept {
  Hold& h = state_.holds[static_cast<std::size_t>(hold)];
  if (parts_.twist && h.holds_roll) twist_.detach(state_, hold);
  const bool directed = h.directed;
  h = Hold{};
  if (directed) moved();
}

double Rod::fastest() const noexcept {
  double most2 = 0.0;
  for (const auto& v : state_.v) most2 = std::max(most2, dot(v, v));
  return std::sqrt(most2);
}

void Rod::broad_phase(double dt_s) noexcept {
  const double diameter = 2.0 * material_.radius_m;
  margin_m_ = 0.5 * diameter + 2.6 * fastest() * std::max(0.25 * numerics_.tick_s, dt_s);
  travel_m_ = 0.0;
  stale_ = false;
  report_.cap_hit |= !broad_.build(state_, diameter, margin_m_, contacts_.pairs);
  ++report_.broad_phases;
}

// One substep: forces and matrix, what touches what, velocities, positions.
template <unsigned Bits>
void Rod::substep(double dt_s) noexcept {
  constexpr bool kTouches = (Bits & (kContact | kWorld)) != 0;
  assemble<(Bits & kTwist) != 0>(material_, state_, gravity, dt_s, forces_, solver_);
  const int n = state_.nodes();
  int first = (n - 2) / 2, last = first + 1;
  [[maybe_unused]] ContactReport seen;
  [[maybe_unused]] double look = 0.0, near = 0.0;
  if constexpr (kTouches) {
    contacts_.begin();
    near = 0.2 * material_.radius_m;
    look = near + 4.0 * fastest() * dt_s;
    if constexpr ((Bits & kContact) != 0) {
      if (stale_ || 2.0 * travel_m_ + look > margin_m_) broad_phase(dt_s);
      contacts_.collect_thread(state_, travel_m_, look, near, dt_s, material_.friction, seen);
    }
    if constexpr ((Bits & kWorld) != 0) {
      if (has_floor) contacts_.collect_floor(state_, floor_m, material_.radius_m, look, floor_friction, seen);
      for (std::size_t b = 0; b < bodies.size(); ++b) {
        contacts_.collect_body(state_, bodies[b], static_cast<int>(b), material_.radius_m, look, seen);
      }
    }
    if (!contacts_.empty()) {
      first = contacts_.window_first();
      last = contacts_.window_last();
      if (first == last) (last + 1 < n ? last : first) += last + 1 < n ? 1 : -1;
    }
  }
  solver_.factor((first + last) / 2);
  bool free = true;
  if constexpr (kTouches) {
    if (!contacts_.empty()) {
      free = false;
      if (dt_s != metric_dt_ || !metric_.covers(first, last)) {
        metric_dt_ = dt_s;
        metric_.prepare(state_.mesh, material_, dt_s, std::max(first - 2, 0), std::min(last + 2, n - 1));
      }
      const int passes =
          std::clamp(numerics_.passes_per_substep * report_.substeps - report_.passes, 4, numerics_.max_passes);
      contacts_.settle<(Bits & kFriction) != 0>(solver_, metric_, numerics_, passes, settled_m_per_s_, dt_s, first,
                                                last, state_.v.data(), seen);
      contacts_.store();
    }
  }
  if (free) solver_.solve(first, last, nullptr, state_.v.data(), true);
  solver_.solve_outside(first, last, state_.v.data());
  double step_s = dt_s;
  if constexpr (kTouches) {
    const double speed = fastest();
    double fraction = contacts_.safe_fraction(state_.v.data(), dt_s);
    const double unseen = 0.45 * (2.0 * material_.radius_m + look);  // what each half of an unmeasured pair may move
    if (speed * dt_s > unseen && (Bits & kContact) != 0) {  // a jerk, such as a release: look again, at today's speed
      broad_phase(dt_s);
      fraction = std::min(fraction, contacts_.measured_fraction(state_, state_.v.data(), dt_s));
    }
    report_.guard_events += fraction < 1.0;
    step_s *= fraction;
    travel_m_ += speed * step_s;
    report_.contacts = static_cast<int>(contacts_.contacts().size());
    report_.passes += seen.passes;
    report_.min_gap_m = std::min(report_.min_gap_m, seen.min_gap_m);
    report_.cap_hit |= seen.cap_hit;
  }
  for (std::size_t i = 0; i < state_.x.size(); ++i) state_.x[i] += step_s * state_.v[i];
}

Rod::Substep Rod::pick(const Parts& parts) noexcept {
  static constexpr auto kTable = []<std::size_t... I>(std::index_sequence<I...>) {
    return std::array<Substep, sizeof...(I)>{&Rod::substep<I>...};
  }
  (std::make_index_sequence<16>{});
  return kTable[(parts.twist ? kTwist : 0) | (parts.contact ? kContact : 0) | (parts.friction ? kFriction : 0) |
                (parts.world ? kWorld : 0)];
}

void Rod::tick() noexcept {
  std::array<Vec, kMaxHolds> goals;
  for (std::size_t h = 0; h < kMaxHolds; ++h) goals[h] = state_.holds[h].target;
  tick(goals);
}

void Rod::tick(const std::array<Vec, kMaxHolds>& goals) noexcept {
  report_ = TickReport{};
  std::array<Vec, kMaxHolds> starts;
  double hand_speed = 0.0;
  for (std::size_t h = 0; h < kMaxHolds; ++h) {
    starts[h] = state_.holds[h].target;
    if (state_.holds[h].node < 0) continue;
    state_.holds[h].velocity = (1.0 / numerics_.tick_s) * (goals[h] - starts[h]);
    hand_speed = std::max(hand_speed, norm(state_.holds[h].velocity));
  }
  if (parts_.adaptive && refine_.update(material_, state_, forces_, contacts_)) {
    ++report_.remeshes;
    moved();
    refine_.keep_stress(material_, state_);
  }
  if (parts_.twist) twist_.update(material_, state_, forces_);
  settled_m_per_s_ = numerics_.settled_m_per_s + numerics_.settled_share * hand_speed;
  report_.substeps = hand_speed > numerics_.fast_m_per_s ? numerics_.max_substeps : numerics_.substeps;
  const double dt = numerics_.tick_s / report_.substeps;
  for (int k = 0; k < report_.substeps; ++k) {
    const double share = static_cast<double>(k + 1) / report_.substeps;
    for (int h = 0; h < state_.hold_count; ++h) {
      const auto at = static_cast<std::size_t>(h);
      state_.holds[at].target = starts[at] + share * (goals[at] - starts[at]);
    }
    (this->*substep_)(dt);
  }
  for (int h = 0; h < state_.hold_count; ++h) {
    Hold& hold = state_.holds[static_cast<std::size_t>(h)];
    if (hold.node < 0 || hold.rigid) continue;
    const auto i = static_cast<std::size_t>(hold.node);
    hold.force =
        hold.stiffness_N_per_m * (state_.x[i] - hold.target) + hold.damping_N_s_per_m * (state_.v[i] - hold.velocity);
  }
}

}  // namespace ligature::physics::rod
