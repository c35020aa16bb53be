// A thread lies round a peg that moves along its own axis. Measured is how the force that holds the thread back depends
// on the tension of the thread's ends.

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "firmware/physics/rod/rod_simulation.hpp"
#include "host/lab/published/case.hpp"
#include "host/lab/validate/specimen.hpp"

namespace ligature::published {
namespace {

using physics::Vec3;
using physics::rod::RodSimulation;

constexpr double kPi = std::numbers::pi;
constexpr double kRadius_m = 0.005;  // R: radius of the thread's centreline on the peg, 33 thread radii
constexpr double kPitch_m = 0.0015;  // advance along the peg per turn, so that the thread does not lie on itself
constexpr int kPerTurn = 40;         // segments
constexpr double kTail_R = 5.0;      // length of each free end, in R
// Coefficient of friction, so low that the ends lean by less than 2 degrees: the wrapped thread stays nearly in the
// plane of the theory.
constexpr double kFriction = 0.005;
constexpr double kSpeed_m_per_s = 0.02;  // of the peg's surface, along its axis
constexpr double kEI_N_m2 = 4e-7;
constexpr double kEA_N = 7.1;  // a tenth of the suture's: sweeps converge sooner, and the strain stays below 2 %

/// Sum of the normal forces on the peg, divided by the tension T of the ends; from planar elastica theory. A flexible
/// thread would touch the peg of radius R over the angle theta. A rod of bending stiffness B leaves the peg earlier, by
/// an angle delta on each side; its curvature there is 1/R. Between these two points the tension is T cos(delta) = T -
/// B / (2 R^2), and at each of them the peg carries a point force T sin(delta). If theta < 2 delta, the rod touches the
/// peg in one point.
/// @param load T R^2 / B, above 1/2
double normal_over_tension(double theta, double load) {
  const double inside = 1.0 - 0.5 / load, delta = std::acos(inside);
  if (theta < 2.0 * delta) return 2.0 * std::sin(0.5 * theta);
  return inside * (theta - 2.0 * delta) + 2.0 * std::sin(delta);
}

/// The thread lies round the peg over the angle theta. Constant forces along the tangents pull its ends. The peg's
/// surface moves along the peg's axis, and two springs that act along this axis only hold the ends back.
class Pulled {
 public:
  Pulled(const Subject& subject, double theta)
      : theta_(theta), sim_(make(subject, theta)), tools_(validate::no_hands()) {
    sim_.rod().bodies.front().velocity = physics::rod::make(0.0, kSpeed_m_per_s, 0.0);
    for (std::size_t h = 0; h < 2; ++h) tools_[h].p_WT = start_[h] = end(h), tools_[h].grip = true;
  }

  /// Force along the axis while the thread slides, N, at this tension of the ends.
  double sliding_N(double tension_N) {
    for (std::size_t h = 0; h < 2; ++h) {
      const Vec3 f = tension_N * outward(h);
      auto& load = sim_.rod().state().load;
      (h == 0 ? load.front() : load.back()) = physics::rod::make(f.x(), f.y(), f.z());
    }
    double sum = 0.0;
    for (int k = 0; k < kSettle + kCounted; ++k) {
      tick();
      if (k >= kSettle) sum += along_axis_N() / kCounted;
    }
    return sim_.diagnostics().finite ? sum : std::nan("");
  }

  /// Largest angle between the thread and the plane perpendicular to the peg's axis, degrees.
  [[nodiscard]] double tilt_deg() const {
    const auto nodes = sim_.nodes_W();
    double most = 0.0;
    for (std::size_t k = 0; k + 1 < nodes.size(); ++k) {
      const Vec3 along = nodes[k + 1] - nodes[k];
      most = std::max(most, std::asin(std::abs(along.y()) / along.norm()));
    }
    return most * 180.0 / kPi;
  }

 private:
  static constexpr int kSettle = 600, kCounted = 100;

  static Vec3 tangent(double a) { return {std::sin(a), 0.0, std::cos(a)}; }
  [[nodiscard]] Vec3 outward(std::size_t h) const { return h == 0 ? Vec3(-tangent(0.0)) : tangent(theta_); }
  [[nodiscard]] Vec3 end(std::size_t h) const { return h == 0 ? sim_.nodes_W().front() : sim_.nodes_W().back(); }

  static RodSimulation make(const Subject& subject, double theta) {
    const int wrapped = static_cast<int>(std::lround(kPerTurn * theta / (2.0 * kPi)));
    const double rise = kPitch_m / (2.0 * kPi), per_rad = std::hypot(kRadius_m, rise);
    const double arc = theta * per_rad, l = arc / wrapped;
    const int tail_segments = static_cast<int>(std::lround(kTail_R * kRadius_m / l));
    auto scene = validate::real_thread(subject.rod(wrapped + 2 * tail_segments + 1), 1.0, kFriction);
    scene.suture.length_m = l * (scene.suture.nodes - 1);
    validate::set_bending(scene, kEI_N_m2);
    validate::set_stretch(scene, kEA_N);
    scene.hands.coupling_N_per_m = 100.0;
    scene.hands.coupling_N_s_per_m = 0.0;
    scene.world.pegs.push_back({{0, -1, 0}, {0, 1, 0}, kRadius_m - scene.suture.radius_m});
    const double tail = l * tail_segments;
    validate::lay(scene, [&](double s) -> Vec3 {
      const double along = s - tail, a = std::clamp(along / per_rad, 0.0, theta);
      const Vec3 on_peg(-kRadius_m * std::cos(a), rise * a, kRadius_m * std::sin(a));
      return on_peg + std::min(0.0, along) * tangent(0.0) + std::max(0.0, along - arc) * tangent(theta);
    });
    auto made = RodSimulation::make(scene);
    if (auto* why = std::get_if<std::string>(&made)) throw std::runtime_error(*why);
    return std::get<RodSimulation>(std::move(made));
  }

  // The springs' other ends follow the thread in the directions perpendicular to the axis.
  void tick() {
    for (std::size_t h = 0; h < 2; ++h) {
      const Vec3 at = end(h);
      tools_[h].p_WT = {at.x(), start_[h].y(), at.z()};
    }
    validate::proceed(sim_, tools_);
  }

  [[nodiscard]] double along_axis_N() const {
    return sim_.hand(physics::Hand::kLeft).f_W.y() + sim_.hand(physics::Hand::kRight).f_W.y();
  }

  double theta_;
  RodSimulation sim_;
  validate::Tools tools_;
  Vec3 start_[2];
};

/// Slope of log(y) over log(x), least squares.
double exponent(const std::vector<double>& x, const std::vector<double>& y) {
  double n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0;
  for (std::size_t k = 0; k < x.size(); ++k) {
    const double a = std::log(x[k]), b = std::log(y[k]);
    n += 1, sx += a, sy += b, sxx += a * a, sxy += a * b;
  }
  return (n * sxy - sx * sy) / (n * sxx - sx * sx);
}

}  // namespace

Result capstan_axis(const Subject& subject) {
  Result result;
  const std::vector<double> loads = subject.quick ? std::vector{1.0, 3.0, 9.0} : std::vector{1.0, 1.7, 3.0, 5.2, 9.0};
  const std::vector<double> quarters = subject.quick ? std::vector{1.0, 16.0} : std::vector{1.0, 2.0, 4.0, 8.0, 16.0};
  double before = 0.0, least_rise = 1.0;
  for (const double quarter : quarters) {
    const double theta = 0.25 * kPi * quarter;
    const std::string at = "theta = " + std::to_string(0.25 * quarter).substr(0, 4) + " pi: ";
    Pulled thread(subject, theta);
    std::vector<double> forces;
    for (const double load : loads) {
      const double tension = load * kEI_N_m2 / (kRadius_m * kRadius_m);
      forces.push_back(thread.sliding_N(tension));
      const double theory = normal_over_tension(theta, load), measured = forces.back() / (kFriction * tension);
      result.points.push_back({at.substr(0, at.size() - 2), load, theory, measured});
      if (load == loads.front() || load == loads.back()) {
        const std::string where = " at T R^2 / B = " + std::to_string(load).substr(0, 1);
        result.findings.push_back(validate::relative(at + "F / (mu T)" + where, theory, measured, 0.05));
        result.findings.push_back(reported(at + "tilt of the thread" + where, thread.tilt_deg(), "deg"));
      }
    }
    const double power = exponent(loads, forces);
    if (quarter == quarters.front()) {
      result.findings.push_back(validate::absolute(at + "exponent of F in T", 1.0, power, 0.02, ""));
    } else {
      least_rise = std::min(least_rise, power - before);
      result.findings.push_back(reported(at + "exponent of F in T", power, ""));
    }
    before = power;
  }
  result.findings.push_back(validate::within("exponent above 1 at the largest theta", 1.05, 2.0, before));
  result.findings.push_back(
      validate::within("least rise of the exponent from one theta to the next", 0.0, 1.0, least_rise));
  return result;
}

}  // namespace ligature::published
