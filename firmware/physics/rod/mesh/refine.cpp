#include "firmware/physics/rod/mesh/refine.hpp"
#include "firmware/physics/rod/tuning.hpp"

#include <algorithm>
#include <cmath>
#include <compare>
#include <queue>

namespace ligature::physics::rod {
namespace {

constexpr double kCut = 0.5;         // share of a segment that the smooth curve cuts off at a corner (h, smooth.hpp)
constexpr double kLeastFade = 1e-3;  // > 0, as Spin::before_fading() divides by the factor

// A segment of the initial mesh. Segments are ordered by the ratio of length to wanted length, then by nearness to the
// thread's middle.
struct Piece {
  double excess;
  std::int32_t nearness, at, length;
  auto operator<=>(const Piece&) const = default;
};

// Wanted segment length at every mesh unit of the thread, from the given curvature; constant if no curvature is given.
// The wanted length changes only gradually along the thread (tuning.grading).
std::vector<double> wanted_at_rest(int units, double unit_m, std::span<const double> curvature_per_m) {
  std::vector<double> wanted(static_cast<std::size_t>(units), unit_m * (1 << Refine::kLevels));
  const double per_place = static_cast<double>(units) / static_cast<double>(curvature_per_m.size());
  for (std::size_t k = 0; k < curvature_per_m.size(); ++k) {
    auto& w = wanted[static_cast<std::size_t>(per_place * (static_cast<double>(k) + 0.5))];
    w = std::max(unit_m, std::min(w, tuning.start_turn_rad / std::max(curvature_per_m[k], 1e-9)));
  }
  const double more = tuning.grading * unit_m;
  for (std::size_t j = 1; j < wanted.size(); ++j) wanted[j] = std::min(wanted[j], wanted[j - 1] + more);
  for (std::size_t j = wanted.size() - 1; j-- > 0;) wanted[j] = std::min(wanted[j], wanted[j + 1] + more);
  return wanted;
}

Vec mean_velocity(const State& state) noexcept {
  Vec sum{};
  double mass = 0.0;
  for (std::size_t i = 0; i < state.v.size(); ++i) sum += state.mesh.mass[i] * state.v[i], mass += state.mesh.mass[i];
  return (1.0 / mass) * sum;
}

}  // namespace

bool Refine::start(const Material& material, double wanted_m, State& state, std::span<const double> curvature_per_m) {
  const std::size_t n = state.x.size();
  const int coarse = std::max(2, static_cast<int>(std::lround(material.length_m / (wanted_m * (1 << kLevels)))));
  unit_m_ = material.length_m / (coarse << kLevels);
  if (n < static_cast<std::size_t>(coarse) + 1 || n > static_cast<std::size_t>(coarse << kLevels) + 1) return false;
  const auto wanted = wanted_at_rest(coarse << kLevels, unit_m_, curvature_per_m);
  std::priority_queue<Piece> pieces;
  const auto add = [&](std::int32_t at, std::int32_t length) {
    const double least = *std::min_element(wanted.begin() + at, wanted.begin() + at + length);
    const std::int32_t aside = std::abs(at + length / 2 - (coarse << kLevels) / 2);
    pieces.push({length > 1 ? length * unit_m_ / least : 0.0, -aside, at, length});
  };
  for (int i = 0; i < coarse; ++i) add(i << kLevels, 1 << kLevels);
  while (pieces.size() + 1 < n) {
    const Piece longest = pieces.top();
    pieces.pop();
    add(longest.at, longest.length / 2);
    add(longest.at + longest.length / 2, longest.length / 2);
  }
  at_.assign(1, coarse << kLevels);
  at_.reserve(n);
  for (; !pieces.empty(); pieces.pop()) at_.push_back(pieces.top().at);
  std::sort(at_.begin(), at_.end());
  for (std::size_t i = 0; i < n; ++i) state.mesh.s[i] = unit_m_ * at_[i];
  wanted_.assign(n, 0.0);
  free_.assign(n, 1);
  moment_.assign(n, Vec{});
  fade_.assign(n, tuning.fade);
  strain_fade_.assign(n, tuning.fade);
  tension_.assign(n, 0.0);
  return true;
}

void Refine::want(const State& state, const Forces& forces, const ContactSet& contacts) noexcept {
  const Mesh& mesh = state.mesh;
  const std::size_t n = mesh.s.size();
  const double coarsest = unit_m_ * (1 << kLevels);
  std::fill(wanted_.begin(), wanted_.end(), coarsest);
  std::fill(free_.begin(), free_.end(), 1);
  free_[0] = free_[n - 1] = 0;
  for (std::size_t i = 1; i + 1 < n; ++i) {
    const Vec bend = forces.tangent[i] - forces.tangent[i - 1];
    const double length = tuning.turn_rad * 0.5 * (mesh.rest[i - 1] + mesh.rest[i]) / (norm(bend) + 1e-9);
    wanted_[i - 1] = std::min(wanted_[i - 1], length);
    wanted_[i] = std::min(wanted_[i], length);
    if (dot(state.load[i], state.load[i]) > 0.0) free_[i] = 0;
  }
  for (const Hold& hold : state.slots())
    if (hold.node >= 0) free_[hold.node] = 0;
  for (const auto& c : contacts.contacts()) {
    for (int k = 0; k < c.count; ++k) free_[c.node[k]] = 0;
    const double force = norm(c.p) * contacts.per_second();
    if (force == 0.0) continue;
    for (int k = 0; k < std::min(c.count, 4); k += 2) {
      const auto j = std::min(static_cast<std::size_t>(c.node[k]), n - 2);
      const double pull = std::max({force, forces.tension[j], 1e-9});
      wanted_[j] = std::min(wanted_[j], tuning.bend_length * std::sqrt(mesh.EI_after[j] / pull));
    }
  }
  grade(mesh);
  want_at_rest(state, contacts);
}

void Refine::grade(const Mesh& mesh) noexcept {
  const std::size_t n = mesh.s.size();
  for (auto& w : wanted_) w = std::max(w, unit_m_);
  for (std::size_t j = 1; j + 1 < n; ++j) {
    wanted_[j] = std::min(wanted_[j], wanted_[j - 1] + tuning.grading * 0.5 * (mesh.rest[j - 1] + mesh.rest[j]));
  }
  for (std::size_t j = n - 2; j-- > 0;) {
    wanted_[j] = std::min(wanted_[j], wanted_[j + 1] + tuning.grading * 0.5 * (mesh.rest[j + 1] + mesh.rest[j]));
  }
}

// Two segments in contact get equal wanted lengths if the contact is at rest. Sliding has no effect: nodes would be
// moved continually, each time with a small step of the force. A segment at rest against one of unit length has
// priority over all others (tuning.first).
void Refine::want_at_rest(const State& state, const ContactSet& contacts) noexcept {
  for (const auto& c : contacts.contacts()) {
    if (!c.is_pair() || dot(c.p, c.p) == 0.0) continue;
    Vec u{};
    for (int k = 0; k < c.count; ++k) u += c.w[k] * state.v[c.node[k]];
    u -= dot(u, c.n) * c.n;
    if (dot(u, u) > loose_m_per_s() * loose_m_per_s()) continue;
    double& one = wanted_[c.node[0]];
    double& other = wanted_[c.node[2]];
    const double least = std::max(unit_m_, std::min(one, other));
    one = other = least > unit_m_ ? least : tuning.first * unit_m_;
  }
}

int Refine::worst_segment() const noexcept {
  double most = 0.0;
  int worst = -1;
  for (std::size_t j = 0; j + 1 < at_.size(); ++j) {
    const int length = at_[j + 1] - at_[j];
    const double ratio = length * unit_m_ / wanted_[j];
    if (length > 1 && ratio > most) most = ratio, worst = static_cast<int>(j);
  }
  return worst;
}

int Refine::cheapest_merge(double most) const noexcept {
  double least = most;
  int best = -1;
  for (std::size_t i = 1; i + 1 < at_.size(); ++i) {
    const int before = at_[i] - at_[i - 1], after = at_[i + 1] - at_[i];
    if (!free_[i] || before != after || before >= (1 << kLevels) || at_[i - 1] % (2 * before) != 0) continue;
    const double ratio = 2 * before * unit_m_ / std::min(wanted_[i - 1], wanted_[i]);
    if (ratio < least) least = ratio, best = static_cast<int>(i);
  }
  return best;
}

// Removes node i; its two segments become one.
void Refine::merge(const Material& material, State& state, int node) noexcept {
  const auto i = static_cast<std::size_t>(node);
  // Mass that each neighbour gets: half of node i's mass, because the two merged segments are equally long
  const double half = 0.5 * material.density_kg_per_m * (state.mesh.s[i] - state.mesh.s[i - 1]);
  for (const std::size_t k : {i - 1, i + 1}) {
    const double before = k > 0 ? state.mesh.s[k] - state.mesh.s[k - 1] : 0.0;
    const double after = k + 1 < at_.size() ? state.mesh.s[k + 1] - state.mesh.s[k] : 0.0;
    const double mass = 0.5 * material.density_kg_per_m * (before + after);
    state.v[k] = (1.0 / (mass + half)) * (mass * state.v[k] + half * state.v[i]);
  }
  tension_[i - 1] = 0.5 * (tension_[i - 1] + tension_[i]);
  state.cut_before[i - 1] *= 0.5;  // the same length, as a share of a segment twice as long
  state.cut_after[i - 1] = 0.5 * state.cut_after[i];
  const auto erase = [at = static_cast<std::ptrdiff_t>(i)](auto&... arrays) {
    (arrays.erase(arrays.begin() + at), ...);
  };
  erase(at_, wanted_, free_, tension_, moment_);
  erase(state.cut_before, state.cut_after, state.mesh.s, state.x, state.v, state.load);
  for (Hold& hold : state.slots()) hold.node -= hold.node > node;
}

// Inserts a node in the middle of a segment's chord.
void Refine::split(State& state, int segment) noexcept {
  const auto j = static_cast<std::size_t>(segment), i = j + 1;
  const auto insert = [&](auto& array, auto value) {  // never allocates: merge() has made room
    array.insert(array.begin() + static_cast<std::ptrdiff_t>(i), value);
  };
  insert(at_, (at_[j] + at_[i]) / 2);
  insert(state.mesh.s, unit_m_ * at_[i]);
  insert(state.x, 0.5 * (state.x[j] + state.x[i]));
  insert(state.v, 0.5 * (state.v[j] + state.v[i]));
  insert(state.load, Vec{});
  insert(moment_, 0.5 * (moment_[j] + moment_[i]));
  insert(state.cut_before, kCut);
  insert(state.cut_after, std::min(1.0, 2.0 * state.cut_after[j]));
  state.cut_before[j] = std::min(1.0, 2.0 * state.cut_before[j]);
  state.cut_after[j] = kCut;
  insert(tension_, tension_[j]);
  insert(wanted_, wanted_[j]);
  insert(free_, char{1});
  for (Hold& hold : state.slots()) hold.node += hold.node > segment;
}

// Computes the factors by which the offsets (stress-free bends and strains that remeshing has left) fade. An offset is
// right only for the place where its node was when the offset was set, so it fades faster the faster the node moves.
// The exponent is quadratic in the speed, so that slow motion, such as the one caused by the fading itself, has almost
// no effect.
void Refine::slide(const State& state, double tick_s, bool drifts) noexcept {
  const double per_m = tick_s / (tuning.away * unit_m_);
  const Vec drift = drifts ? mean_velocity(state) : Vec{};
  for (std::size_t i = 0; i < fade_.size(); ++i) {
    const Vec v = state.v[i] - drift;
    fade_[i] = std::max(kLeastFade, tuning.fade * std::exp(-per_m * per_m * dot(v, v)));
  }
  std::fill(strain_fade_.begin(), strain_fade_.end(), tuning.fade);
}

// Weakens the fading of offsets, as far as needed, where it adds stress: there it would raise the elastic energy
// without a source.
double Refine::hold_back(const Material& material, const State& state, std::span<const Vec> born,
                         double allowance_J) noexcept {
  const Mesh& mesh = state.mesh;
  const std::size_t n = at_.size();
  const auto bend_gain = [&](std::size_t i) {
    const Vec freed = (1.0 - fade_[i]) * (born.empty() ? state.rest_bend[i] : state.rest_bend[i] - born[i]);
    return mesh.weight[i] * (dot(state.elastic_bend(i), freed) + 0.5 * dot(freed, freed));
  };
  const auto strain_gain = [&](std::size_t j) {
    const double freed = (1.0 - strain_fade_[j]) * state.rest_strain[j];
    return material.EA_N * mesh.rest[j] * (state.elastic_strain(j) * freed + 0.5 * freed * freed);
  };
  double up_J = 0.0, down_J = 0.0;
  const auto count = [&](double gain_J) { (gain_J > 0.0 ? up_J : down_J) += gain_J; };
  for (std::size_t i = 1; i + 1 < n; ++i) count(bend_gain(i));
  for (std::size_t j = 0; j + 1 < n; ++j) count(strain_gain(j));
  if (up_J + down_J <= allowance_J) return up_J + down_J;
  // The energy gain is a convex function of the amount of fading. So with only this share of the fading, the gain is at
  // most this share of the full gain
  const double share = (allowance_J - down_J) / up_J;
  for (std::size_t i = 1; i + 1 < n; ++i)
    if (bend_gain(i) > 0.0) fade_[i] = 1.0 - share * (1.0 - fade_[i]);
  for (std::size_t j = 0; j + 1 < n; ++j)
    if (strain_gain(j) > 0.0) strain_fade_[j] = 1.0 - share * (1.0 - strain_fade_[j]);
  return allowance_J;
}

void Refine::fade_offsets(State& state) const noexcept {
  for (std::size_t i = 0; i < at_.size(); ++i) {
    state.rest_bend[i] = fade_[i] * state.rest_bend[i];
    state.cut_before[i] = kCut + fade_[i] * (state.cut_before[i] - kCut);
    if (i > 0) state.cut_after[i - 1] = kCut + fade_[i] * (state.cut_after[i - 1] - kCut);
    state.rest_strain[i] *= strain_fade_[i];
  }
}

bool Refine::update(const Material& material, State& state, const Forces& forces, ContactSet& contacts,
                    const std::vector<Body>& bodies, Work& work) noexcept {
  want(state, forces, contacts);
  const std::size_t n = at_.size();
  bool changed = false;
  const long price_of_one = price::kChangePerNode * static_cast<long>(n);
  while (work.left() >= price_of_one && work.time().allows()) {
    work.spend(price_of_one);
    const int segment = worst_segment();
    if (segment < 0) break;
    const auto j = static_cast<std::size_t>(segment);
    const double bad = (at_[j + 1] - at_[j]) * unit_m_ / wanted_[j];
    const int node = bad > 1.0 ? cheapest_merge(bad / tuning.worth) : -1;
    if (node < 0 || segment == node || segment + 1 == node) break;
    if (!merge_is_clear(material, state, bodies, static_cast<std::size_t>(node))) {
      free_[node] = 0;
      continue;
    }
    if (!changed) {
      for (std::size_t q = 0; q + 1 < n; ++q) tension_[q] = material.EA_N * state.elastic_strain(q);
      moment_[0] = moment_[n - 1] = Vec{};
      for (std::size_t q = 1; q + 1 < n; ++q) moment_[q] = state.mesh.weight[q] * state.elastic_bend(q);
    }
    changed = true;
    merge(material, state, node);
    split(state, segment > node ? segment - 1 : segment);
  }
  if (!changed) return false;
  contacts.relabel(state.mesh.s);
  return true;
}

void Refine::keep_stress(const Material& material, State& state) noexcept {
  const Mesh& mesh = state.mesh;
  const std::size_t n = at_.size();
  for (std::size_t j = 0; j + 1 < n; ++j) state.rest_strain[j] = state.strain(j) - tension_[j] / material.EA_N;
  for (std::size_t i = 1; i + 1 < n; ++i) {
    if (mesh.weight[i] == 0.0) continue;
    state.rest_bend[i] = state.bend(i) - (1.0 / mesh.weight[i]) * moment_[i];
  }
}

}  // namespace ligature::physics::rod
