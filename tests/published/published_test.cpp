// Runs the quick form of every case of `ligature-lab published` at the rig's setting. One line a test, so that a case
// is added without touching another's.

#include "host/lab/published/case.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>

namespace ligature::published {
namespace {

/// Runs a case's quick form. Every judged figure must hold, except those named in `missed`, which
/// docs/measurements/published.md explains. When one of these holds by a margin, that page must be changed; one near
/// its tolerance may hold with one compiler and miss with another.
validate::Findings expect_met(const std::string& name, const std::set<std::string>& missed = {},
                              scene::Accuracy accuracy = scene::Accuracy::kBalanced) {
  const auto all = all_cases();
  const auto c = std::find_if(all.begin(), all.end(), [&](const Case& k) { return name == k.name; });
  EXPECT_NE(c, all.end());
  if (c == all.end()) return {};
  const auto result = c->measure({accuracy, true});
  EXPECT_FALSE(result.points.empty());
  int judged = 0;
  for (const auto& f : result.findings) {
    judged += is_judged(f);
    const bool may_miss = missed.contains(f.what), holds_well = f.holds() && f.error < 0.75 * f.tolerance;
    EXPECT_TRUE(may_miss ? !holds_well : f.holds())
        << f.what << ": " << f.measured << " for " << f.reference << ", error " << f.error << " " << f.unit
        << ", tolerance " << f.tolerance;
  }
  EXPECT_GT(judged, 0);
  for (const auto& name_of_missed : missed)
    EXPECT_TRUE(std::ranges::any_of(result.findings, [&](const auto& f) { return f.what == name_of_missed; }))
        << name_of_missed;
  return result.findings;
}

// knots and braids in an elastic thread
TEST(Published, Trefoil) { expect_met("trefoil"); }
TEST(Published, Braid) { expect_met("braid", {"n = 2: F over eq. (5)", "n = 2: l/n over 2 pi 12^(1/4) sqrt(h R)"}); }
TEST(Published, HelicesRoundABentBackbone) {
  std::set<std::string> missed;
  for (const char* radius : {"100", "70", "50", "35", "30", "20", "15"})
    missed.insert("backbone radius " + std::string(radius) + ": squared curvature of the rod");
  expect_met("helices", missed);
}
TEST(Published, PlyWithoutFriction) {
  expect_met("ply");
  expect_met("ply", {}, scene::Accuracy::kFine);
}

// knots of throws in sutures
TEST(Published, Locking) { expect_met("locking"); }
TEST(Published, Threshold) {
  // The mean locking friction. No publication gives a value for it, so the test compares it with
  // docs/measurements/published.md: a wrong factor in the friction would change it.
  for (const auto& f : expect_met("threshold")) {
    if (f.what.ends_with("mean")) {
      EXPECT_NEAR(f.measured, 0.36, 0.04) << f.what;
    }
  }
}
// At balanced the knot of three throws needs more work than the budget has.
TEST(Published, Cyclic) { expect_met("cyclic", {}, scene::Accuracy::kFine); }
TEST(Published, Post) { expect_met("post"); }

// friction round a bar
TEST(Published, Capstan) {
  // The tolerance is 2 %; with a brake that lets strands be pressed into the bar one turn is 1.7 % off
  for (const auto& f : expect_met("capstan")) {
    if (is_judged(f)) {
      EXPECT_LT(f.error, 0.01) << f.what;
    }
  }
  expect_met("capstan", {}, scene::Accuracy::kFine);
}

TEST(Published, CapstanPulledAlongItsAxis) {
  const std::string at = "theta = 4.00 pi: F / (mu T) at T R^2 / B = ";
  expect_met("capstan-axis", {at + "1"});
  // Why one figure misses at `fine`: below T R^2 / B = 3/2 coils that lie flat are unstable. They become steeper, up to
  // an angle a with cos(a)^4 = T R^2 / (1.5 B), which is 25.4 degrees here. The closed form assumes flat coils.
  const auto all = expect_met("capstan-axis", {at + "1"}, scene::Accuracy::kFine);
  const auto tilt = [&](const std::string& load) {
    const std::string what = "theta = 4.00 pi: tilt of the thread at T R^2 / B = " + load;
    const auto f = std::find_if(all.begin(), all.end(), [&](const auto& k) { return k.what == what; });
    return f == all.end() ? std::nan("") : f->measured;
  };
  EXPECT_GT(tilt("1"), 12.0);
  EXPECT_LT(tilt("1"), 25.4);
  EXPECT_LT(tilt("9"), 5.0);
}

TEST(Published, Drum) {
  expect_met("drum");
  expect_met("drum", {}, scene::Accuracy::kFine);
}

TEST(Published, EveryCaseHasItsOwnNameAndASource) {
  std::set<std::string> names;
  for (const auto& c : all_cases()) {
    EXPECT_TRUE(names.insert(c.name).second) << c.name;
    EXPECT_GT(std::string(c.source).size(), 4U) << c.name;
  }
}

TEST(Published, AReportedFigureIsNotJudgedButMustBeANumber) {
  EXPECT_TRUE(reported("", 3.0, "").holds());
  EXPECT_FALSE(is_judged(reported("", 3.0, "")));
  EXPECT_FALSE(reported("", std::nan(""), "").holds());
  EXPECT_TRUE(is_judged(validate::relative("", 1.0, 1.0, 0.1)));
}

}  // namespace
}  // namespace ligature::published
