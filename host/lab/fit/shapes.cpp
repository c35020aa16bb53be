#include "host/lab/fit/shapes.hpp"

#include <Eigen/Dense>
#include <cmath>
#include <complex>
#include <numbers>

#include "host/lab/fit/material.hpp"

namespace ligature::fit {
namespace {

/// The elastica EI theta'' = -w (L - s) cos theta with theta'(L) = 0: theta is the slope angle at arc length s, w the
/// weight per length. Integrated by Runge-Kutta from the tip (s = L) to the clamp, with lengths in units of L.
struct Shot {
  double clamp_angle_rad, sag;
};
Shot shoot(double load, double tip_angle_rad) {
  constexpr int kSteps = 60;
  constexpr double h = 1.0 / kSteps;
  const auto bend = [load](double from_tip, double angle) { return -load * from_tip * std::cos(angle); };
  double angle = tip_angle_rad, slope = 0.0, sag = 0.0;  // slope: d angle / d(distance from the tip)
  for (int k = 0; k < kSteps; ++k) {
    const double u = k * h;
    const double a1 = slope, b1 = bend(u, angle);
    const double a2 = slope + 0.5 * h * b1, b2 = bend(u + 0.5 * h, angle + 0.5 * h * a1);
    const double a3 = slope + 0.5 * h * b2, b3 = bend(u + 0.5 * h, angle + 0.5 * h * a2);
    const double a4 = slope + h * b3, b4 = bend(u + h, angle + h * a3);
    const double next = angle + h / 6.0 * (a1 + 2.0 * a2 + 2.0 * a3 + a4);
    const double middle = angle + 0.5 * h * slope + 0.125 * h * h * b1;
    sag += h / 6.0 * (std::sin(angle) + 4.0 * std::sin(middle) + std::sin(next));
    slope += h / 6.0 * (b1 + 2.0 * b2 + 2.0 * b3 + b4);
    angle = next;
  }
  return {angle, sag};
}

// Ritz functions x^2 .. x^(kTerms + 1) on 0 .. 1: clamped at 0, free at 1.
constexpr int kTerms = 7;
using Matrix = Eigen::MatrixXd;
struct Ritz {
  Matrix mass{kTerms, kTerms}, bending{kTerms, kTerms}, weight{kTerms, kTerms};
  Ritz() {
    for (int i = 0; i < kTerms; ++i) {
      for (int j = 0; j < kTerms; ++j) {
        const double p = i + 2, q = j + 2;
        mass(i, j) = 1.0 / (p + q + 1.0);
        bending(i, j) = p * (p - 1.0) * q * (q - 1.0) / (p + q - 3.0);
        weight(i, j) = p * q * (1.0 / (p + q - 1.0) - 1.0 / (p + q));  // the tension is the weight below
      }
    }
  }
};

}  // namespace

double sag_over_length(double load) {
  // The angle at the clamp grows with the angle at the tip. Regula falsi (Illinois) finds the tip's angle for which the
  // clamp is horizontal.
  double low = 0.0, high = 0.5 * std::numbers::pi, under = shoot(load, low).clamp_angle_rad, over = high;
  Shot last{};
  for (int k = 0; k < 60; ++k) {
    const double tip = high - over * (high - low) / (over - under);
    last = shoot(load, tip);
    if (std::abs(last.clamp_angle_rad) < 1e-12 || high - low < 1e-14) break;
    if (last.clamp_angle_rad > 0.0) {
      high = tip, over = last.clamp_angle_rad, under *= 0.5;
    } else {
      low = tip, under = last.clamp_angle_rad, over *= 0.5;
    }
  }
  return last.sag;
}

Swing swing_of(const Hanging& t) {
  static const Ritz ritz;
  const double L = t.length_m;
  const Matrix bending = t.EI_N_m2 / (t.density_kg_per_m * std::pow(L, 4)) * ritz.bending;
  const Matrix stiffness = bending + kGravity_m_per_s2 / L * ritz.weight;
  const Eigen::GeneralizedSelfAdjointEigenSolver<Matrix> modes(stiffness, ritz.mass);
  // Bending is damped and gravity is not, so the damped mode x differs from the undamped one. It solves Q(s) x = 0 with
  // Q(s) = s^2 M + s (c M + tau K_bend) + K: M mass, K stiffness, K_bend its part by bending, c air drag, tau bend
  // damping time. Found by inverse iteration; s is the root of x^T Q(s) x.
  using Complex = std::complex<double>;
  Eigen::VectorXcd x = modes.eigenvectors().col(0).cast<Complex>();
  Complex s;
  for (int k = 0; k < 4; ++k) {
    const auto over = [&x](const Matrix& m) { return (x.transpose() * (m.cast<Complex>() * x)).value(); };
    const Complex m = over(ritz.mass), half = 0.5 * (t.drag_per_s * m + t.damping_s * over(bending)) / m;
    s = -half + std::sqrt(half * half - over(stiffness) / m);
    const Eigen::MatrixXcd q = ((s * s + s * t.drag_per_s) * ritz.mass.cast<Complex>() +
                                s * t.damping_s * bending.cast<Complex>() + stiffness.cast<Complex>());
    x = q.partialPivLu().solve(ritz.mass.cast<Complex>() * x).normalized();
  }
  return {2.0 * std::numbers::pi / std::abs(s.imag()), -s.real()};
}

}  // namespace ligature::fit
