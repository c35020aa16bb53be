// Taut strands that are hooked over each other never pass through each other, whatever the nodes, the angle and the
// place where they cross, while one is lifted into the other and slides along it. The strands do not resist bending, so
// they meet at sharp corners: one lies in a groove between two segments of the other.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "tests/support/random.hpp"
#include "tests/unit/rod/rods.hpp"

namespace ligature::test {
namespace {

using physics::rod::kMaxHolds;

struct Case {
  int nodes, strand;             ///< of the thread; segments of a strand
  double angle_rad, diameter_m;  ///< between the strands
  double at_a, at_b;             ///< where they cross, share of the strand
  double EA_N, strain, friction;
  double lift_m, slide_m;  ///< way of strand B upwards, then along strand A
};

constexpr double kStrand_m = 0.1;

Case drawn(Random& random) {
  Case c{};
  c.nodes = static_cast<int>(random.any(20, 200));
  c.strand = c.nodes / 3;
  c.angle_rad = random.in(10.0, 90.0) * std::numbers::pi / 180.0;
  c.diameter_m = random.happens(0.5) ? 3e-4 : 1e-3;
  const bool at_nodes = random.happens(0.5);  // else anywhere within a segment
  const auto place = [&] {
    const double share = random.in(0.35, 0.65);
    return at_nodes ? std::round(share * c.strand) / c.strand : share;
  };
  c.at_a = place();
  c.at_b = place();
  c.EA_N = std::pow(10.0, random.in(2.0, 3.0));
  c.strain = random.in(0.0, 0.005);
  c.friction = random.happens(0.5) ? 0.0 : 0.3;
  c.lift_m = random.in(0.02, 0.2) * kStrand_m;
  c.slide_m = random.in(-0.1, 0.1) * kStrand_m;
  return c;
}

/// One thread whose first segments are strand A, along x, and whose last are strand B, below A. A slack piece joins
/// them. All four ends are fixed; those of B move.
class Hooked {
 public:
  explicit Hooked(const Case& c) : c_(c), rod_(material(c), Numerics{}, kParts, c.nodes) {
    const double l = rod_.state().mesh.rest[0], way = (1.0 + c.strain) * l;
    const Vec b = make(std::cos(c.angle_rad), std::sin(c.angle_rad), 0.0), low = make(0, 0, -1.1 * c.diameter_m);
    const int k = c.strand, first = c.nodes - 1 - k;
    auto& x = rod_.state().x;
    const auto node = [&](int i) -> Vec& { return x[static_cast<std::size_t>(i)]; };
    for (int i = 0; i <= k; ++i) {
      node(i) = make((i - c.at_a * k) * way, 0, 0);
      node(first + i) = low + ((i - c.at_b * k) * way) * b;
    }
    lay_slack(node(k), node(first), k, first, l);
    for (const int i : {0, k, first, c.nodes - 1}) goals_[static_cast<std::size_t>(rod_.support(i, node(i)))] = node(i);
    rod_.moved();
  }
  void tick(Vec way) {
    goals_[2] += way, goals_[3] += way;
    rod_.tick(goals_);
  }
  /// Height of strand A above strand B where they cross in the view from above, least of all crossings, diameters.
  [[nodiscard]] double height_d() const {
    const auto& x = rod_.state().x;
    double least = 1e9;
    for (std::size_t i = 0; i < static_cast<std::size_t>(c_.strand); ++i) {
      for (std::size_t j = x.size() - 1 - static_cast<std::size_t>(c_.strand); j + 1 < x.size(); ++j) {
        const Vec e = x[i + 1] - x[i], f = x[j + 1] - x[j], r = x[j] - x[i];
        const double det = f[0] * e[1] - e[0] * f[1];
        const double s = (f[0] * r[1] - r[0] * f[1]) / det, t = (e[0] * r[1] - r[0] * e[1]) / det;
        if (s >= 0.0 && s <= 1.0 && t >= 0.0 && t <= 1.0) least = std::min(least, s * e[2] - r[2] - t * f[2]);
      }
    }
    return least / c_.diameter_m;
  }

 private:
  static constexpr Parts kParts{false, true, true, false, false};
  static Material material(const Case& c) {
    Material m;
    m.radius_m = 0.5 * c.diameter_m;
    m.length_m = kStrand_m / c.strand * (c.nodes - 1);
    m.EA_N = c.EA_N, m.EI_N_m2 = 0.0, m.friction = c.friction;
    m.stretch_tau_s = 1e-5;
    m.drag_per_s = 300.0;
    return m;
  }
  // From p to q by a detour in the plane of strand A, away from both strands.
  void lay_slack(Vec p, Vec q, int from, int to, double l) {
    const Vec apart = q - p;
    const double half = 0.5 * norm(apart), leg = 0.5 * (to - from) * l;
    const Vec across = make(apart[1], -apart[0], 0.0);
    const double side = dot(across, p + q) < 0.0 ? -1.0 : 1.0;
    const Vec apex = 0.5 * (p + q) + (side * std::sqrt(std::max(0.0, leg * leg - half * half)) / norm(across)) * across;
    for (int i = from + 1; i < to; ++i) {
      const double share = 2.0 * (i - from) / (to - from);
      rod_.state().x[static_cast<std::size_t>(i)] =
          share < 1.0 ? p + share * (apex - p) : apex + (share - 1.0) * (q - apex);
    }
  }

  Case c_;
  Rod rod_;
  std::array<Vec, kMaxHolds> goals_{};
};

TEST(Hooked, TautStrandsNeverPass) {
  Random random(41);
  double least = 1e9;
  int hooked = 0;
  for (int round = 0; round < 40; ++round) {
    const Case c = drawn(random);
    Hooked strands(c);
    double now = 0.0;
    for (int k = 0; k < 160; ++k) {
      const bool lifts = k < 60, slides = k >= 80 && k < 140;
      strands.tick(lifts ? make(0, 0, c.lift_m / 60) : slides ? make(c.slide_m / 60, 0, 0) : Vec{});
      now = strands.height_d();
      least = std::min(least, now);
      ASSERT_GT(now, 0.7) << "round " << round << " tick " << k << ": " << c.nodes << " nodes, " << c.angle_rad
                          << " rad, d " << c.diameter_m << ", EA " << c.EA_N << ", strain " << c.strain << ", at "
                          << c.at_a << " " << c.at_b << ", friction " << c.friction << ", lift " << c.lift_m
                          << ", slide " << c.slide_m;
    }
    hooked += now < 2.0;
  }
  EXPECT_EQ(hooked, 40);  // the strands still press on each other
  RecordProperty("least_height_d", std::to_string(least));
}

}  // namespace
}  // namespace ligature::test
