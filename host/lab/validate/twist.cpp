// Two classic instabilities of twisted rods: a straight clamped rod and a ring, each twisted to 2 % below and above the
// critical value.

#include <cmath>
#include <numbers>
#include <string>

#include "host/lab/validate/cases.hpp"
#include "host/lab/validate/reference.hpp"
#include "host/lab/validate/rods.hpp"

namespace ligature::validate {
namespace {

constexpr double kPi = std::numbers::pi;

/// Growth rate per tick of a tiny disturbance, which grows or decays exponentially; measured over two intervals of
/// `ticks`.
double clamped_rod_growth(int n, double moment) {
  Material m = unit_rod();
  m.EA_N = 1e4;
  m.drag_per_s = 50.0;
  Rod rod(m, steps_of(0.02), kTwisting, n);
  rod.clamp(0, make(0, 0, 0), make(1, 0, 0));
  const int end = rod.clamp(n - 1, make(1, 0, 0), make(1, 0, 0));
  wind(rod, end, moment * m.length_m / m.GJ_N_m2);
  for (std::size_t i = 1; i + 1 < rod.state().x.size(); ++i) {
    const double s = rod.state().mesh.s[i], bump = 1e-6 * (1.0 - std::cos(2.0 * kPi * s));
    rod.state().x[i] += make(0, bump * std::cos(4.5 * s), bump * std::sin(4.5 * s));
  }
  const auto size = [&] {
    double sum = 0.0;
    for (const auto& x : rod.state().x) sum += x[1] * x[1] + x[2] * x[2];
    return sum;
  };
  const int ticks = 1500;
  for (int k = 0; k < ticks; ++k) proceed(rod);
  const double early = size();
  for (int k = 0; k < ticks; ++k) proceed(rod);
  return 0.5 * std::log(size() / early) / ticks;
}

/// Whether a twisted ring buckles: it then flips, and its twist turns into writhe.
bool twisted_ring_buckles(int n, double turns_over_critical, double bend_over_twist) {
  Material m = unit_rod();
  m.GJ_N_m2 = m.EI_N_m2 / bend_over_twist;
  m.drag_per_s = 50.0;
  Rod rod(m, steps_of(0.01), kTwisting, n);
  const double radius = m.length_m / (2.0 * kPi);
  for (std::size_t i = 0; i < rod.state().x.size(); ++i) {
    const double a = 2.0 * kPi * static_cast<double>(i) / (n - 1);
    rod.state().x[i] = make(radius * std::sin(a), radius * (1.0 - std::cos(a)), 0);
  }
  rod.clamp(0, make(0, 0, 0), make(1, 0, 0));
  const int end = rod.clamp(n - 1, make(0, 0, 0), make(1, 0, 0));
  const double angle = turns_over_critical * 2.0 * kPi * std::sqrt(3.0) * bend_over_twist;
  wind(rod, end, angle);
  for (std::size_t i = 1; i + 1 < rod.state().x.size(); ++i) {
    rod.state().x[i] += make(0, 0, 1e-6 * (1.0 - std::cos(4.0 * kPi * rod.state().mesh.s[i])));
  }
  for (int k = 0; k < 6500; ++k) proceed(rod);
  return std::abs(rod.twist().turn_rad(0) - angle) > 1.0;
}

/// Bisection for the value between low and high at which `unstable` becomes true, in `times` steps.
template <class Unstable>
double threshold(double low, double high, int times, Unstable unstable) {
  for (int k = 0; k < times; ++k) {
    const double middle = 0.5 * (low + high);
    (unstable(middle) ? high : low) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace

void wind(Rod& rod, int hold, double angle_rad) {
  const int steps = static_cast<int>(std::ceil(std::abs(angle_rad)));
  for (int k = 0; k < steps; ++k) {
    Twist::roll(rod.state().holds[static_cast<std::size_t>(hold)], angle_rad / steps);
    proceed(rod);
  }
}

Findings clamped_twist(const Subject& subject) {  // reference: moment M with ML/B = 8.98682, a root of tan(x/2) = x/2
  double critical = 0.0;
  for (const auto& row : reference_rows("04_twist_buckling_straight_rod.csv")) {
    if (number(row, "TL2_over_B") == 0.0) critical = number(row, "ML_over_B_clamped_clamped");
  }
  const double found = critical * threshold(0.95, 1.05, 7, [&](double share) {
                         return clamped_rod_growth(subject.nodes, share * critical) > 0.0;
                       });
  return {relative("ML/B at which the straight rod buckles", critical, found, 0.02)};
}

// reference: sqrt(3) B / C turns, B bending and C twisting stiffness [Michell 1890]. The clamp at one point only
// prevents rigid motion.
Findings michell_ring(const Subject& subject) {
  Findings all;
  for (const auto& row : reference_rows("04_michell_ring.csv")) {
    const double ratio = number(row, "B_over_C(=EI/GJ=1+nu_for_circular)");
    if (ratio != 1.0 && ratio != 1.4) continue;
    const double found = number(row, "critical_twist_turns") * threshold(0.96, 1.04, 4, [&](double share) {
                           return twisted_ring_buckles(subject.nodes, share, ratio);
                         });
    all.push_back(
        relative("B/C = " + row.at("B_over_C(=EI/GJ=1+nu_for_circular)") + ": turns at which the ring buckles",
                 number(row, "critical_twist_turns"), found, 0.02));
  }
  return all;
}

}  // namespace ligature::validate
