// Runs the quick cases of `ligature-lab validate` for every thread model with 50 nodes; for the rod also with 200 where
// that is quick.

#include <gtest/gtest.h>

#include <cmath>

#include "host/lab/validate/cases.hpp"
#include "host/lab/validate/convergence.hpp"
#include "host/lab/validate/reference.hpp"
#include "protocol/scene/scene_file.hpp"

namespace ligature::validate {
namespace {

std::string test_name(const std::string& case_name, const char* suffix) {
  std::string name;
  for (const char c : case_name) name += c == '-' ? '_' : c;
  return name + suffix;
}

void expect_all_within(const Case& c, const Subject& subject) {
  const auto findings = c.examine(subject);
  EXPECT_FALSE(findings.empty());
  for (const auto& f : findings) {
    EXPECT_TRUE(f.holds()) << f.what << ": " << f.measured << " for " << f.reference << ", error " << f.error << " "
                           << f.unit << ", tolerance " << f.tolerance;
  }
}

std::vector<Case> quick_cases() {
  std::vector<Case> quick;
  for (const auto& c : all_cases()) {
    if (c.quick) quick.push_back(c);
  }
  return quick;
}

class TheRod : public testing::TestWithParam<Case> {};

TEST_P(TheRod, AgreesAtFiftyNodes) { expect_all_within(GetParam(), {scene::Model::kRod, 50}); }

INSTANTIATE_TEST_SUITE_P(Case, TheRod, testing::ValuesIn(quick_cases()),
                         [](const auto& test) { return test_name(test.param.name, ""); });

// Checks that a validation case judges every row of its reference table.
struct Judged {
  const char *case_name, *table;
  int figures_a_row;
  const char* only_kind = "";
};

class EveryRow : public testing::TestWithParam<Judged> {};

TEST_P(EveryRow, IsJudged) {
  const auto& judged = GetParam();
  std::size_t rows = 0;
  for (const auto& row : reference_rows(judged.table))
    rows += *judged.only_kind == '\0' || row.at("kind") == judged.only_kind;
  EXPECT_EQ(find_case(judged.case_name)->examine({scene::Model::kRod, 50}).size(),
            static_cast<std::size_t>(judged.figures_a_row) * rows);
}

INSTANTIATE_TEST_SUITE_P(Case, EveryRow,
                         testing::Values(Judged{"elastica-tip", "01_elastica_tip_load.csv", 1},
                                         Judged{"elastica-heavy", "01_heavy_elastica.csv", 1},
                                         Judged{"catenary", "02_catenary_inextensible.csv", 2},
                                         Judged{"elastic-string", "02_hanging_elastic_string.csv", 1},
                                         Judged{"stopping-distance", "05_stopping_distance.csv", 1},
                                         Judged{"crossing-threads", "06_crossing_threads.csv", 4, "elastic"},
                                         Judged{"heavy-rod-lifted", "06_heavy_rod_lifted_from_plane.csv", 1}),
                         [](const auto& test) { return test_name(test.param.case_name, ""); });

class TheRodOfTwoHundred : public testing::TestWithParam<const char*> {};

TEST_P(TheRodOfTwoHundred, Agrees) { expect_all_within(*find_case(GetParam()), {scene::Model::kRod, 200}); }

INSTANTIATE_TEST_SUITE_P(Case, TheRodOfTwoHundred,
                         testing::Values("elastica-tip", "elastica-heavy", "catenary", "elastic-string",
                                         "hanging-chain", "cantilever", "clamped-twist", "localised-helix",
                                         "stopping-distance", "heavy-rod-lifted"),
                         [](const auto& test) { return test_name(test.param, ""); });

TEST(TheRodAtFine, DoesNotCreep) {
  expect_all_within(*find_case("stick-creep"), {scene::Model::kRod, 50, scene::Accuracy::kFine});
}

class PaperFour : public testing::TestWithParam<const char*> {};

TEST_P(PaperFour, AgreesAtFiftyNodes) { expect_all_within(*find_case(GetParam()), {scene::Model::kPaper4, 50}); }

INSTANTIATE_TEST_SUITE_P(Case, PaperFour, testing::Values("catenary", "elastic-string", "hanging-chain", "cantilever"),
                         [](const auto& test) { return test_name(test.param, ""); });

// Runs only cases of effects that the model has. For example, the crossing strands of a reference are Hookean, but
// model 5's stretch is quadratic.
class EveryPaperModel : public testing::TestWithParam<scene::Model> {};

TEST_P(EveryPaperModel, AgreesInContactAndUnderItsOwnWeight) {
  int judged = 0;
  for (const char* name : {"elastica-heavy", "crossing-threads", "heavy-rod-lifted"}) {
    const Case& c = *find_case(name);
    if (!c.is_modelled(GetParam())) continue;
    ++judged;
    expect_all_within(c, {GetParam(), 50});
  }
  EXPECT_EQ(judged, GetParam() == scene::Model::kPaper1 ? 1 : GetParam() == scene::Model::kPaper5 ? 2 : 3);
}

INSTANTIATE_TEST_SUITE_P(Model, EveryPaperModel,
                         testing::Values(scene::Model::kPaper1, scene::Model::kPaper2, scene::Model::kPaper3,
                                         scene::Model::kPaper4, scene::Model::kPaper5),
                         [](const auto& test) { return test_name(scene::name(test.param), ""); });

TEST(Finding, OutsideItsToleranceOrNotANumberDoesNotHold) {
  EXPECT_TRUE(relative("", 2.0, 2.01, 0.006).holds());
  EXPECT_FALSE(relative("", 2.0, 2.02, 0.006).holds());
  EXPECT_FALSE(absolute("", 0.0, std::nan(""), 1.0, "").holds());
  EXPECT_TRUE(within("", 16.4, 18.0, 17.0).holds());
  EXPECT_FALSE(within("", 16.4, 18.0, 18.1).holds());
  EXPECT_FALSE(within("", 16.4, 18.0, std::nan("")).holds());
}

TEST(Reference, QuotedHeadersKeepTheirCommas) {
  const auto rows = reference_rows("07_elastic_knot_constants.csv");
  EXPECT_NEAR(number(rows.front(), "sigma_radius_based=J/(2sqrt2)"), 0.4923, 1e-4);
  EXPECT_THROW(static_cast<void>(reference_rows("none.csv")), std::runtime_error);
}

TEST(Ladder, OrderIsTheSlope) {
  const Ladder second{"", {1, 2, 4, 8}, {1.0, 0.25, 0.0625, 0.015625}};
  EXPECT_NEAR(second.order(), 2.0, 1e-12);
}

}  // namespace
}  // namespace ligature::validate
