// Compares the banded solver of one substep's linear system with a dense solver: for every window (the range of nodes
// whose solution is asked for), and on a matrix that is numerically hard.

#include "firmware/physics/rod/solve/band_solver.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "firmware/physics/rod/solve/band_columns.hpp"
#include "tests/support/random.hpp"

namespace ligature::physics::rod {
namespace {

Vec column(const Mat& m, int k) { return k == 0 ? m.x : k == 1 ? m.y : m.z; }

struct WholeMatrix {
  Eigen::MatrixXd a;
  Eigen::VectorXd r;
};

WholeMatrix dense(const BandSolver& s, int n) {
  WholeMatrix d{Eigen::MatrixXd::Zero(3 * n, 3 * n), Eigen::VectorXd(3 * n)};
  for (int i = 0; i < n; ++i) {
    const auto k = static_cast<std::size_t>(i);
    for (int row = 0; row < 3; ++row) {
      d.r(3 * i + row) = s.rhs[k][row];
      for (int col = 0; col < 3; ++col) {
        d.a(3 * i + row, 3 * i + col) = column(s.diagonal[k], col)[row];
        if (i + 1 < n)
          d.a(3 * i + row, 3 * i + 3 + col) = d.a(3 * i + 3 + col, 3 * i + row) = column(s.couple[k], col)[row];
      }
      if (i + 2 < n) d.a(3 * i + row, 3 * i + 6 + row) = d.a(3 * i + 6 + row, 3 * i + row) = s.skip[k];
    }
  }
  return d;
}

BandSolver random_system(int n, unsigned seed) {
  test::Random random(seed);
  const auto normal = [&] { return random.normal(); };
  const auto vector = [&] { return Vec{{normal(), normal(), normal(), 0.0}}; };
  BandSolver s;
  s.resize(n);
  for (std::size_t i = 0; i < static_cast<std::size_t>(n); ++i) {
    s.diagonal[i] = dyad(vector(), 1.0) + scaled_identity(20.0);  // large enough for a positive definite matrix
    s.couple[i] = dyad(vector(), 1.0) + scaled_identity(-2.0);
    s.skip[i] = normal();
    s.rhs[i] = vector();
  }
  return s;
}

// BandColumns gives columns of the inverse of the matrix that it was given, even after the solver has factorised
// another one.
TEST(BandColumns, AreThoseOfTheInverse) {
  BandColumns columns;
  columns.reserve();
  for (const int n : {2, 3, 4, 5, 17, 60}) {
    for (int core = 0; core + 1 < n; core += 1 + n / 9) {
      BandSolver s = random_system(n, static_cast<unsigned>(n));
      const Eigen::MatrixXd truth = dense(s, n).a.inverse();
      const int first = std::max(core - n / 2, 0), last = std::min(core + 1 + n / 3, n - 1);
      s.factor(core);
      columns.take(s, first, last);
      EXPECT_TRUE(columns.covers(first, last));
      s = random_system(n, 77);
      s.factor(n / 3);
      for (int j = last; j >= first; --j) ASSERT_TRUE(columns.want(j - first));
      ASSERT_EQ(columns.missing(), last - first + 1);
      columns.make_missing();
      for (int i = first; i <= last; ++i) {
        for (int j = first; j <= last; ++j) {
          const float* const block =
              columns.column(j - first) + static_cast<std::ptrdiff_t>(BandColumns::kBlock) * (i - first);
          for (int k = 0; k < 9; ++k)
            ASSERT_NEAR(static_cast<double>(block[4 * (k / 3) + k % 3]), truth(3 * i + k % 3, 3 * j + k / 3), 1e-8)
                << n << " " << core << " " << i << " " << j;
        }
      }
    }
  }
}

TEST(BandColumns, SayWhenThereIsNoRoom) {
  BandColumns columns;
  columns.reserve();
  BandSolver s = random_system(BandColumns::kWidest, 5);
  s.factor(300);
  columns.take(s, 0, BandColumns::kWidest - 1);
  int made = 0;
  while (made < BandColumns::kWidest && columns.want(made)) ++made;
  columns.make_missing();
  EXPECT_EQ(made, static_cast<int>(BandColumns::kRoom) / BandColumns::kWidest);
  EXPECT_TRUE(columns.want(made - 1));
}

// The matrices are well-conditioned, so the tolerance is a hundred roundings.
TEST(BandSolver, AgreesWithADenseSolverForEveryCoreAndWindow) {
  for (const int n : {3, 4, 5, 17, 60}) {
    for (int core = 0; core + 1 < n; core += 1 + n / 20) {
      for (int width = 0; width < n; width += 1 + n / 10) {
        const int first = std::max(core - width, 0), last = std::min(core + 1 + width / 2, n - 1);
        BandSolver s = random_system(n, static_cast<unsigned>(n));
        const WholeMatrix d = dense(s, n);
        const Eigen::VectorXd truth = d.a.ldlt().solve(d.r);
        std::vector<Vec> v(static_cast<std::size_t>(n));
        s.factor(core);
        s.solve(first, last, nullptr, v.data(), true);
        s.solve_outside(first, last, v.data());
        for (int i = 0; i < 3 * n; ++i)
          ASSERT_NEAR(v[static_cast<std::size_t>(i / 3)][i % 3], truth(i), 1e-12) << n << " " << core << " " << width;
      }
    }
  }
}

TEST(BandSolver,
     AnswersForTheWindowAlone) {  // the response to a right-hand side inside the window is A^-1 restricted to it
  const int n = 40, first = 11, last = 23;
  BandSolver s = random_system(n, 5);
  const WholeMatrix d = dense(s, n);
  std::vector<Vec> extra(n), out(n);
  Eigen::VectorXd r = Eigen::VectorXd::Zero(3 * n);
  for (int i = first; i <= last; ++i) {
    extra[static_cast<std::size_t>(i)] = make(i, 1.0, -0.5 * i);
    r.segment<3>(3 * i) << i, 1.0, -0.5 * i;
  }
  const Eigen::VectorXd truth = d.a.ldlt().solve(r);
  s.factor(14);
  s.solve(first, last, extra.data(), out.data(), false);
  for (int i = first; i <= last; ++i) {
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(out[static_cast<std::size_t>(i)][k], truth(3 * i + k), 1e-12);
  }
}

TEST(BandSolver, StaysAccurateAlongALongStiffBeam) {  // unsymmetric rounding errors would double at every node
  const int n = 400;
  BandSolver s;
  s.resize(n);
  for (std::size_t i = 0; i < static_cast<std::size_t>(n); ++i) {
    const double phase = 0.01 * static_cast<double>(i);
    const Mat stretch = dyad(make(std::cos(phase), std::sin(phase), 0.3), 50.0);
    s.diagonal[i] = scaled_identity(6.01) + 2.0 * stretch;
    s.couple[i] = scaled_identity(-4.0) - stretch;
    s.skip[i] = 1.0;
    s.rhs[i] = make(1.0, -2.0, 0.5);
  }
  const WholeMatrix d = dense(s, n);
  const Eigen::VectorXd truth = d.a.ldlt().solve(d.r);
  std::vector<Vec> v(n);
  s.factor(n / 2);
  s.solve(0, n - 1, nullptr, v.data(), true);
  for (int i = 0; i < 3 * n; ++i) ASSERT_NEAR(v[static_cast<std::size_t>(i / 3)][i % 3], truth(i), 1e-7 * truth.norm());
}

}  // namespace
}  // namespace ligature::physics::rod
