#pragma once
// Knots as polylines from formulas, as input for knot recognition.

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "tests/support/random.hpp"

namespace ligature::knot::shapes {

using Polyline = std::vector<std::array<double, 3>>;
inline constexpr double kTurn = 2.0 * std::numbers::pi;

/// n points of a closed curve f(t), 0 <= t < 2 pi.
template <class F>
Polyline closed_curve(int n, F f) {
  Polyline line;
  for (int k = 0; k < n; ++k) line.push_back(f(kTurn * k / n));
  return line;
}

/// The trefoil in its usual pose; `hand` is the sign of z. With + sin 3t it is right-handed (writhe +3.4 by Gauss'
/// integral); with - sin 3t, as often printed, it is left-handed.
inline Polyline trefoil(int n, int hand = 1) {
  return closed_curve(n, [hand](double t) {
    return std::array{std::sin(t) + 2 * std::sin(2 * t), std::cos(t) - 2 * std::cos(2 * t), hand * std::sin(3 * t)};
  });
}

inline Polyline figure_eight(int n) {
  return closed_curve(n, [](double t) {
    const double r = 2 + std::cos(2 * t);
    return std::array{r * std::cos(3 * t), r * std::sin(3 * t), std::sin(4 * t)};
  });
}

/// Torus knot T(2, q), q odd; right-handed for q > 0.
inline Polyline torus_knot(int q, int n) {
  return closed_curve(n, [q](double t) {
    const double r = 2 + std::cos(q * t);
    return std::array{r * std::cos(2 * t), r * std::sin(2 * t), -std::sin(q * t)};
  });
}

/// Closure of a braid. In `word`, +-k means that strand k crosses k + 1 (k from 1); positive letters make right-handed
/// crossings. The braid runs along x, two units per letter; the strands return far away in y.
inline Polyline braid_closure(const std::vector<int>& word, int strands) {
  const double end = 2.0 * static_cast<double>(word.size()) + 1.0;
  Polyline line;
  int at = 0;
  do {
    line.push_back({0.0, static_cast<double>(at), 0.0});
    double x = 0.5;
    for (const int letter : word) {
      const int k = std::abs(letter) - 1;
      line.push_back({x, static_cast<double>(at), 0.0});
      if (at == k || at == k + 1) {
        // A crossing is right-handed when turning the over strand counter-clockwise by less than half a turn gives the
        // under strand's direction (seen from +z). Here that is the strand going down, so the strand going up is under.
        const bool up = at == k;
        const bool over = (letter > 0) != up;
        const double to = up ? k + 1 : k;
        line.push_back({x + 0.75, (static_cast<double>(at) + to) / 2, over ? 0.4 : -0.4});
        at = static_cast<int>(to);
      }
      x += 2.0;
      line.push_back({x - 0.5, static_cast<double>(at), 0.0});
    }
    const double out = 2.0 + strands - at;  // nested return paths, the top strand innermost
    line.push_back({end, static_cast<double>(at), 0.0});
    line.push_back({end + out, static_cast<double>(at), 0.0});
    line.push_back({end + out, static_cast<double>(strands) + out, 0.0});
    line.push_back({-out, static_cast<double>(strands) + out, 0.0});
    line.push_back({-out, static_cast<double>(at), 0.0});
  } while (at != 0);
  return line;
}

inline Polyline mirrored(Polyline line) {
  for (auto& p : line) p[2] = -p[2];
  return line;
}

/// Rotates the line randomly and adds noise of the given size to every point.
inline Polyline posed(Polyline line, test::Random& random, double noise) {
  const auto normal = [&] { return random.normal(); };
  const Eigen::Quaterniond q = Eigen::Quaterniond{normal(), normal(), normal(), normal()}.normalized();
  for (auto& p : line) {
    const Eigen::Vector3d v = q * Eigen::Vector3d(p[0], p[1], p[2]);
    p = {v.x() + noise * normal(), v.y() + noise * normal(), v.z() + noise * normal()};
  }
  return line;
}

/// Splits every edge into n equal parts.
inline Polyline refined(const Polyline& line, int n) {
  Polyline fine;
  for (std::size_t k = 0; k < line.size(); ++k) {
    const auto &a = line[k], &b = line[(k + 1) % line.size()];
    for (int i = 0; i < n; ++i) {
      const double u = static_cast<double>(i) / n;
      fine.push_back({a[0] + u * (b[0] - a[0]), a[1] + u * (b[1] - a[1]), a[2] + u * (b[2] - a[2])});
    }
  }
  return fine;
}

/// The unknot with a dozen or more crossings: a long bight laid along a trefoil, its two strands twisted about each
/// other. Pulling the bight back undoes it.
inline Polyline doubled_trefoil(int n, double twist) {
  constexpr double kGap = 0.5, kApart = 0.08;
  const auto at = [&](double t, double side) {
    const double x = std::sin(t) + 2 * std::sin(2 * t), y = std::cos(t) - 2 * std::cos(2 * t), z = -std::sin(3 * t);
    const double turn = twist * t;
    return std::array{x + side * kApart * std::cos(turn), y + side * kApart * std::sin(turn),
                      z + side * kApart * std::sin(turn + 1.0)};
  };
  Polyline line;
  for (int k = 0; k <= n; ++k) line.push_back(at(kGap + (kTurn - kGap) * k / n, 1.0));
  for (int k = n; k >= 0; --k) line.push_back(at(kGap + (kTurn - kGap) * k / n, -1.0));
  return line;
}

/// An unknot that looks tangled: z rises monotonically and the return path runs outside, for any x and y.
inline Polyline tangled_unknot(int n, test::Random& random) {
  const auto angle = [&] { return random.in(0.0, kTurn); };
  Polyline line;
  const double p1 = angle(), p2 = angle();
  for (int k = 0; k < n; ++k) {
    const double t = kTurn * k / n;
    line.push_back({std::sin(5 * t + p1) + std::cos(9 * t), std::cos(7 * t + p2) - std::sin(4 * t), 0.02 * k});
  }
  line.push_back({6.0, 0.0, 0.02 * n + 1});
  line.push_back({6.0, 0.0, -1.0});
  return line;
}

}  // namespace ligature::knot::shapes
