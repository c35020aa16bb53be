// Bends that set: a share f of the bending stiffness gives way where the thread is bent too sharply, and stays bent.
//   M = B (kappa - f z),   |kappa - z| <= kappa_y,   z follows kappa only where the bound would be broken:
// two bending springs side by side, (1 - f) B and f B, the second behind a slider. Linear kinematic hardening [Prager]:
// M has the slope B up to B kappa_y and (1 - f) B beyond; the slider works against f B kappa_y, so
//   energy per length = B / 2 ((1 - f) kappa^2 + f (kappa - z)^2),   dissipation = f B (kappa - z) . dz >= 0.
// Bent to kappa and let go a thread keeps f (kappa - kappa_y), or f kappa_y / (1 - f) where that is less: more is taken
// back by the spring that did not give way. kappa and z are vectors across the thread and roll with it; in a vertex
// they are the turns t_i - t_{i-1} that they make in its share l_i of the thread. kappa counts from the shape it was
// born with.

#include <algorithm>
#include <cmath>

#include "firmware/physics/rod/spin.hpp"

namespace ligature::physics::rod {

// Return mapping: with z moved straight towards D the bound holds at once, so any step is stable and dissipates. What
// remeshing left over (State::rest_bend - born_) is no bend of the thread.
double Spin::yield(const Material& m, State& state) noexcept {
  const Mesh& mesh = state.mesh;
  const std::size_t edges = state.x.size() - 1;
  const double f = m.set_fraction, rest = 1.0 - f;
  double lost_J = 0.0;
  Vec before = mesh.inv_rest[0] * (state.x[1] - state.x[0]);
  for (std::size_t i = 1; i < edges; ++i) {
    const Vec t = mesh.inv_rest[i] * (state.x[i + 1] - state.x[i]);
    const Vec beyond = t - before - state.rest_bend[i] - rest * set_[i];
    const double size2 = dot(beyond, beyond);
    before = t;
    if (size2 <= limit2_[i]) continue;
    const double size = std::sqrt(size2), limit = std::sqrt(limit2_[i]);
    const Vec slip = (1.0 - limit / size) * beyond;
    set_[i] += slip;
    born_[i] += f * slip;
    state.rest_bend[i] += f * slip;
    lost_J += 0.5 * f * mesh.weight[i] * (size2 - limit2_[i]);
  }
  return lost_J;
}

// Between ticks z is told along d_i and t_i x d_i, so that frames carry it.
void Spin::set_to_material() noexcept {
  for (std::size_t i = 1; i < set_.size(); ++i)
    set_[i] = make(dot(set_[i], normal_[i]), dot(set_[i], binormal_[i]), 0.0);
}

void Spin::set_to_world(const Material& material, const Mesh& mesh) noexcept {
  for (std::size_t i = 1; i + 1 < set_.size(); ++i) {
    set_[i] = set_[i][0] * normal_[i] + set_[i][1] * binormal_[i];
    const double limit = material.yield_curvature_per_m * share_of_vertex(mesh, i);
    limit2_[i] = mesh.weight[i] > 0.0 ? limit * limit : 1e9;  // a clamp's half segments do not set
  }
}

// Nodes moved along the thread: its set bends are spread evenly over the shares of the old vertices, and a new vertex
// gets what lies in its own. The sum stays. Shares end in the middles of the segments, but at the ends of the thread.
void Spin::resample_set(double length_m) noexcept {
  const std::size_t last = set_.size() - 2;  // vertices 1 .. last
  std::copy(set_.begin(), set_.end(), old_set_.begin());
  const auto from = [](const std::vector<double>& middle, std::size_t i) { return i == 1 ? 0.0 : middle[i - 1]; };
  const auto to = [&](const std::vector<double>& middle, std::size_t i) { return i == last ? length_m : middle[i]; };
  std::size_t k = 1;
  for (std::size_t i = 1; i <= last; ++i) {
    const double low = from(middle_m_, i), high = to(middle_m_, i);
    Vec sum{};
    while (k < last && to(old_middle_m_, k) <= low) ++k;
    for (std::size_t j = k; j <= last && from(old_middle_m_, j) < high; ++j) {
      const double a = from(old_middle_m_, j), b = to(old_middle_m_, j);
      sum += (std::min(b, high) - std::max(a, low)) / (b - a) * old_set_[j];
    }
    set_[i] = sum;
  }
}

}  // namespace ligature::physics::rod
