// Smooth curves through the thread's segments; contact is computed between them.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "firmware/physics/rod/contact/smooth.hpp"
#include "tests/support/random.hpp"

namespace ligature::test {
namespace {

using namespace physics::rod;

constexpr double kCurveDiameter_m = 3e-4;

State nodes_on_a_circle(int n, double radius_m, double turn) {
  State state;
  state.resize(n);
  for (int i = 0; i < n; ++i) {
    const double a = turn * (i - 0.5 * (n - 1));
    state.x[static_cast<std::size_t>(i)] = make(radius_m * std::sin(a), 0, radius_m * (1.0 - std::cos(a)));
  }
  return state;
}

double closest_by_trying(const SmoothSegment& a, const SmoothSegment& b) {
  double least = 1.0;
  for (int i = 0; i <= 400; ++i) {
    for (int j = 0; j <= 400; ++j) least = std::min(least, norm(b.at(j / 400.0) - a.at(i / 400.0)));
  }
  return least;
}

TEST(Smooth, IsACircleWhereThePolygonIsOne) {
  const double turn = 0.5, radius_m = 0.6e-3, through_middles_m = radius_m * std::cos(0.5 * turn);
  const State state = nodes_on_a_circle(12, radius_m, turn);
  const Vec centre = make(0, 0, radius_m);
  for (std::size_t j = 1; j < 10; ++j) {
    const SmoothSegment segment(state, j, kCurveDiameter_m);
    for (double s = 0.0; s <= 1.0; s += 0.125)
      EXPECT_NEAR(norm(segment.at(s) - centre), through_middles_m, 2e-3 * radius_m) << j << ' ' << s;
  }
}

TEST(Smooth, HasNoCorners) {
  State state = nodes_on_a_circle(9, 0.6e-3, 0.5);
  state.x[4] += make(1e-5, 4e-5, -2e-5);  // unequal lengths and turns
  for (std::size_t j = 0; j + 2 < 9; ++j) {
    const SmoothSegment one(state, j, kCurveDiameter_m), next(state, j + 1, kCurveDiameter_m);
    EXPECT_LT(norm(one.at(1.0) - next.at(0.0)), 1e-12);
    const Vec a = one.along(1.0), b = next.along(0.0);
    EXPECT_LT(norm(cross(a, b)), 1e-9 * norm(a) * norm(b));
  }
}

// Splitting a segment at a point of its chord, as remeshing does, leaves the smooth curve unchanged.
TEST(Smooth, StaysWhereASegmentIsSplit) {
  const State whole = nodes_on_a_circle(9, 0.6e-3, 0.5);
  State split;
  split.resize(10);
  for (std::size_t i = 0; i < 10; ++i) split.x[i] = i <= 4 ? whole.x[i] : whole.x[i - 1];
  split.x[4] = 0.5 * (whole.x[3] + whole.x[4]);
  split.cut_before[3] *= 2.0, split.cut_after[4] *= 2.0;
  const SmoothSegment one(whole, 3, kCurveDiameter_m), first(split, 3, kCurveDiameter_m),
      second(split, 4, kCurveDiameter_m);
  for (double s = 0.0; s <= 0.5; s += 0.0625) {
    EXPECT_LT(norm(first.at(2.0 * s) - one.at(s)), 1e-15) << s;
    EXPECT_LT(norm(second.at(2.0 * s) - one.at(0.5 + s)), 1e-15) << s;
  }
  const SmoothSegment before(whole, 2, kCurveDiameter_m), still(split, 2, kCurveDiameter_m);
  for (double s = 0.0; s <= 1.0; s += 0.125) EXPECT_LT(norm(still.at(s) - before.at(s)), 1e-15) << s;
}

// The version for four pairs at a time gives the same as four single calls, for crossing, parallel, zero-length and
// corner cases.
TEST(Smooth, FourAtATimeAreAsOne) {
  test::Random random(5);
  const auto normal = [&] { return kCurveDiameter_m * random.normal(); };
  const auto vec = [&] { return Vec{{normal(), normal(), normal(), 0.0}}; };
  for (int round = 0; round < 200; ++round) {
    SmoothOf<Vec, double> a[4], b[4];
    for (int l = 0; l < 4; ++l) {
      a[l] = {vec(), vec(), 0.3 * vec(), 0.3 * vec(), 2.0, 1.0 + 0.1 * l};
      b[l] = {vec(), l == 1 ? 1.5 * a[l].e : l == 2 ? Vec{} : vec(), 0.3 * vec(), 0.3 * vec(), 1.0, 2.0};
    }
    const auto four_of = [](const auto& s) {
      const auto each = [&](auto of) { return four(of(s[0]), of(s[1]), of(s[2]), of(s[3])); };
      return SmoothOf<Vecs, Lanes>{each([](const auto& q) { return q.x; }),
                                   each([](const auto& q) { return q.e; }),
                                   each([](const auto& q) { return q.before; }),
                                   each([](const auto& q) { return q.after; }),
                                   {s[0].h_before, s[1].h_before, s[2].h_before, s[3].h_before},
                                   {s[0].h_after, s[1].h_after, s[2].h_after, s[3].h_after}};
    };
    const auto fours = four_of(a), others = four_of(b);
    const auto chords = closest_along(fours.e, others.e, others.x - fours.x);
    const auto curves = closest_on_curves(fours, others, chords);
    for (int l = 0; l < 4; ++l) {
      const auto chord = physics::closest(a[l].x, a[l].x + a[l].e, b[l].x, b[l].x + b[l].e);
      EXPECT_NEAR(chords.distance2[l], chord.distance2, 1e-9 * kCurveDiameter_m * kCurveDiameter_m)
          << round << ' ' << l;
      // Case 1 has parallel segments, where any point is correct.
      EXPECT_NEAR(chords.s[l], chord.s, l == 1 ? 1.0 : 1e-6) << round << ' ' << l;
      if (l == 2) continue;  // case 2 has a segment of zero length, whose curve has no tangent at its middle
      const auto curve = closest_on_curves(a[l], b[l], physics::Closest<Vec>{chords.s[l], chords.t[l], 0.0, Vec{}});
      EXPECT_NEAR(curves.distance2[l], curve.distance2, 1e-9 * kCurveDiameter_m * kCurveDiameter_m)
          << round << ' ' << l;
      EXPECT_NEAR(curves.t[l], curve.t, 1e-6) << round << ' ' << l;
      EXPECT_NEAR(curves.between.y[l], curve.between[1], 1e-6 * kCurveDiameter_m) << round << ' ' << l;
    }
  }
}

TEST(Smooth, ClosestPointsOfBentStrands) {
  const State a = nodes_on_a_circle(8, 0.6e-3, 0.5);
  for (int k = 0; k < 40; ++k) {
    const double yaw = 0.05 * k + 0.6, c = std::cos(yaw), s = std::sin(yaw), along_m = 1e-5 * (k % 13 - 6);
    State b = nodes_on_a_circle(8, 0.6e-3, 0.5);
    for (auto& x : b.x) x = make(c * x[0] + along_m, s * x[0], kCurveDiameter_m + 0.5 * along_m - x[2]);
    for (std::size_t i = 2; i < 5; ++i) {
      for (std::size_t j = 2; j < 5; ++j) {
        const SmoothSegment one(a, i, kCurveDiameter_m), other(b, j, kCurveDiameter_m);
        const auto chords = physics::closest(a.x[i], a.x[i + 1], b.x[j], b.x[j + 1]);
        const double least = closest_by_trying(one, other);
        // Skipped: too far apart for a contact, or a deeper overlap than occurs.
        if (least > 1.2 * kCurveDiameter_m || least < 0.9 * kCurveDiameter_m) continue;
        EXPECT_NEAR(std::sqrt(closest_on_curves(one, other, chords).distance2), least, 1e-2 * kCurveDiameter_m) << k;
        EXPECT_LT(std::abs(least - std::sqrt(chords.distance2)), one.bulge() + other.bulge() + 1e-9);
      }
    }
  }
}

// With a coarse mesh, smoothing moves a corner by at most a third of a diameter; more would let strands pass each
// other.
TEST(Smooth, CutsNoMoreThanStrandsCanSpare) {
  const State state = nodes_on_a_circle(8, 12e-3, 0.5);
  const SmoothSegment segment(state, 3, kCurveDiameter_m);
  EXPECT_NEAR(norm(segment.at(0.0) - state.x[3]), physics::rod::tuning.most_cut_d * kCurveDiameter_m, 1e-9);
}

// A straight strand slides along a bent one: the contact normal turns continuously. Between chords it would jump at
// each corner.
TEST(Smooth, NormalTurnsSteadily) {
  constexpr double kTurn = 0.4;
  const State bent = nodes_on_a_circle(14, 1e-3, kTurn);
  const auto largest_step = [&](bool smooth) {
    Vec before{};
    double largest = 0.0;
    for (double angle = -1.0; angle < 1.0; angle += 0.005) {  // on the inner side of the bend
      const double r = 1e-3 - kCurveDiameter_m;
      const Vec at = make(r * std::sin(angle), 0, 1e-3 - r * std::cos(angle));
      State strand;
      strand.resize(4);
      for (int i = 0; i < 4; ++i) strand.x[static_cast<std::size_t>(i)] = at + make(0, 1e-3 * (i - 1.5), 0);
      physics::Closest<Vec> nearest;
      nearest.distance2 = 1.0;
      for (std::size_t j = 1; j + 2 < 14; ++j) {
        auto c = physics::closest(bent.x[j], bent.x[j + 1], strand.x[1], strand.x[2]);
        if (smooth)
          c = closest_on_curves(SmoothSegment(bent, j, kCurveDiameter_m), SmoothSegment(strand, 1, kCurveDiameter_m),
                                c);
        if (c.distance2 < nearest.distance2) nearest = c;
      }
      const Vec normal = (1.0 / norm(nearest.between)) * nearest.between;
      if (angle > -1.0) largest = std::max(largest, norm(normal - before));
      before = normal;
    }
    return largest;
  };
  EXPECT_GT(largest_step(false), 0.9 * kTurn);
  EXPECT_LT(largest_step(true), 0.12 * kTurn);
}

}  // namespace
}  // namespace ligature::test
