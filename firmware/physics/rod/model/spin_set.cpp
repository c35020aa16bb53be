// Plastic bending ("set"). Where the thread is bent beyond the curvature kappa_y, a share f of its bending stiffness B
// yields. With the moment M, the curvature kappa and the plastic curvature z:
//   M = B (kappa - f z),   |kappa - z| <= kappa_y,   and z changes only to keep this bound.
// This is two bending springs in parallel, (1 - f) B and f B, of which the second is in series with a friction slider:
// linear kinematic hardening [Prager]. M rises with slope B up to B kappa_y, then with slope (1 - f) B. The slider
// resists with the moment f B kappa_y, so
//   energy per length = B / 2 ((1 - f) kappa^2 + f (kappa - z)^2),   dissipation = f B (kappa - z) . dz >= 0.
// A thread that was bent to kappa and released keeps the curvature f (kappa - kappa_y), but at most f kappa_y / (1 -
// f), because beyond that the elastic spring pushes the slider back. kappa and z are vectors perpendicular to the
// thread, and roll with it. At a vertex they are stored as the change of tangent t_i - t_{i-1} over the vertex's length
// l_i. kappa is measured from the thread's initial stress-free shape.

#include <algorithm>
#include <cmath>

#include "firmware/physics/rod/model/spin.hpp"

namespace ligature::physics::rod {

// Return mapping: the plastic curvature z moves towards the curvature kappa until |kappa - z| is within the yield
// limit. So a step of any size is stable and dissipates energy. Offsets of remeshing (State::rest_bend - born_) do not
// count as curvature.
double Spin::yield(const Material& m, State& state) noexcept {
  const Mesh& mesh = state.mesh;
  const std::size_t edges = state.x.size() - 1;
  const double f = m.set_fraction, rest = 1.0 - f;
  double lost_J = 0.0;
  for (std::size_t i = 1; i < edges; ++i) {
    const Vec beyond = state.elastic_bend(i) - rest * set_[i];
    const double size2 = dot(beyond, beyond);
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

// Converts the plastic bends z_i from world coordinates to components along normal_ and binormal_ of their vertices, so
// that the bends turn with the frames when these are updated. set_to_world() converts them back.
void Spin::set_to_material() noexcept {
  for (std::size_t i = 1; i < set_.size(); ++i)
    set_[i] = make(dot(set_[i], normal_[i]), dot(set_[i], binormal_[i]), 0.0);
}

void Spin::set_to_world(const Material& material, const Mesh& mesh) noexcept {
  for (std::size_t i = 1; i + 1 < set_.size(); ++i) {
    set_[i] = set_[i][0] * normal_[i] + set_[i][1] * binormal_[i];
    const double limit = material.yield_curvature_per_m * share_of_vertex(mesh, i);
    limit2_[i] = mesh.weight[i] > 0.0 ? limit * limit : 1e9;  // vertices at a clamp do not yield
  }
}

// After remeshing: spreads the plastic bend of each old vertex evenly over the length of that vertex, and gives each
// new vertex what falls within its length. The sum is conserved. The length of a vertex reaches from midpoint to
// midpoint of its two segments, that of the first and last vertex to the thread's ends.
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
