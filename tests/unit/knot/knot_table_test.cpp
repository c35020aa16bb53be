// Compares the table of knots with KnotInfo's table, up to ten crossings (tests/reference/10_knot_invariants.csv).

#include "host/knot/knot_table.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <set>
#include <sstream>

#include "host/knot/alexander.hpp"
#include "host/knot/common_name.hpp"
#include "host/knot/jones.hpp"
#include "host/knot/polygon.hpp"
#include "host/knot/projection.hpp"
#include "ligature_source_dir.hpp"
#include "tests/unit/knot/shapes.hpp"

namespace ligature::knot {
namespace {

struct Listed {
  std::string type;
  bool chiral;
  std::vector<int> braid, alexander;
  Laurent jones;
  std::size_t crossings() const { return std::stoul(type); }
};

template <class T>
std::vector<T> numbers(const std::string& text) {
  std::istringstream in(text);
  std::vector<T> values;
  for (T value; in >> value;) values.push_back(value);
  return values;
}

const std::vector<Listed>& listed() {
  static const std::vector<Listed> kListed = [] {
    std::ifstream file(LIGATURE_SOURCE_DIR "/tests/reference/10_knot_invariants.csv");
    std::vector<Listed> rows;
    std::string line;
    for (std::getline(file, line); std::getline(file, line);) {
      std::istringstream cells(line);
      std::array<std::string, 6> cell;
      for (auto& c : cell) std::getline(cells, c, ',');
      rows.push_back({cell[0],
                      cell[1] == "chiral",
                      numbers<int>(cell[2]),
                      numbers<int>(cell[3]),
                      {std::stoi(cell[4]), numbers<std::int64_t>(cell[5])}});
    }
    return rows;
  }();
  return kListed;
}

Diagram diagram_of(const std::vector<int>& braid) {
  int strands = 1;
  for (const int letter : braid) strands = std::max(strands, std::abs(letter) + 1);
  std::vector<Point> line;
  for (const auto& p : shapes::braid_closure(braid, strands)) line.emplace_back(p[0], p[1], p[2]);
  jitter(line);  // the strands of a crossing bend above each other
  return project(line, Point(0.013, -0.021, 1).normalized()).value_or(Diagram{});
}

TEST(KnotTable, TheReferenceHasEveryPrimeKnotToTenCrossingsAndItsBraidsHaveItsPolynomials) {
  std::map<std::size_t, int> of_crossings;
  for (const auto& k : listed()) {
    ++of_crossings[k.crossings()];
    const auto d = diagram_of(k.braid);
    EXPECT_EQ(d.crossings(), k.braid.size()) << k.type;
    EXPECT_EQ(alexander(d), k.alexander) << k.type;
    EXPECT_EQ(jones(d), k.jones) << k.type;
  }
  EXPECT_EQ(of_crossings,
            (std::map<std::size_t, int>{{3, 1}, {4, 1}, {5, 2}, {6, 3}, {7, 7}, {8, 21}, {9, 49}, {10, 165}}));
}

TEST(KnotTable, NamesEveryPrimeKnotToEightCrossingsAndItsHand) {
  for (const auto& k : listed()) {
    if (k.crossings() > 8) continue;
    for (const auto& v : {k.jones, mirrored(k.jones)}) {
      const auto name = name_of(k.alexander, v, 8);
      ASSERT_TRUE(name) << k.type;
      EXPECT_EQ(name->type, k.type);
      // the rule of knot_table.hpp: sum of the lowest and the highest exponent
      const int sum = 2 * v.low + static_cast<int>(v.c.size()) - 1;
      EXPECT_EQ(name->handedness, !k.chiral ? "amphichiral" : sum > 0 ? "right" : "left") << k.type;
    }
  }
}

struct Sum {
  std::string type;
  std::size_t crossings;
};

using Polynomials = std::pair<std::vector<int>, Laurent>;
using Universe = std::map<Polynomials, std::vector<Sum>>;

/// Adds every sum of `sum` with knots of the reference from index `first` on, up to ten crossings, in all hands.
void extend(Universe& all, const Polynomials& of, const Sum& sum, std::size_t first) {
  for (std::size_t k = first; k < listed().size(); ++k) {
    const auto& part = listed()[k];
    const Sum longer{sum.type + (sum.type.empty() ? "" : "#") + part.type, sum.crossings + part.crossings()};
    if (longer.crossings > 10) continue;
    Laurent x{0, {of.first.begin(), of.first.end()}}, y{0, {part.alexander.begin(), part.alexander.end()}};
    const auto a = product(x, y).c;
    for (const auto& v : {part.jones, mirrored(part.jones)}) {
      const Polynomials both{{a.begin(), a.end()}, product(of.second, v)};
      all[both].push_back(longer);
      extend(all, both, longer, k);
    }
  }
}

/// Tested for every knot up to ten crossings, prime or composite, in each of its hands, and for each number of
/// crossings that its diagram may have.
TEST(KnotTable, ANameIsGivenOnlyWhereNoOtherKnotHasThePolynomialsAndElseTheCandidatesAreComplete) {
  Universe all;
  extend(all, {{1}, {0, {1}}}, {"", 0}, 0);
  std::set<std::set<std::string>> shared;
  for (const auto& [of, knots] : all) {
    for (std::size_t crossings = 3; crossings <= 10; ++crossings) {
      std::set<std::string> possible;
      for (const auto& k : knots) {
        if (k.crossings <= crossings) possible.insert(k.type);
      }
      if (possible.empty()) continue;
      const auto found = candidates(of.first, of.second, crossings);
      EXPECT_EQ(std::set<std::string>(found.begin(), found.end()), possible) << crossings;
      EXPECT_EQ(found.size(), possible.size()) << *possible.begin();  // none twice
      const bool has_name =
          possible.size() == 1 && std::ranges::none_of(knots, [&](const Sum& k) {
            return k.type.find('#') == std::string::npos && k.crossings > 8 && k.crossings <= crossings;
          });
      const auto name = name_of(of.first, of.second, crossings);
      ASSERT_EQ(name.has_value(), has_name) << *possible.begin() << " of " << crossings;
      if (name) {
        EXPECT_EQ(name->type, *possible.begin());
      }
      if (possible.size() > 1) shared.insert(possible);
    }
    EXPECT_FALSE(name_of(of.first, of.second, 11));
    EXPECT_TRUE(candidates(of.first, of.second, 11).empty());
  }
  EXPECT_EQ(shared, (std::set<std::set<std::string>>{{"10_132", "5_1"},
                                                     {"10_129", "8_8"},
                                                     {"10_156", "8_16"},
                                                     {"4_1#5_2", "9_12"},
                                                     {"10_25", "10_56"},
                                                     {"10_103", "10_40"}}));
}

TEST(KnotTable, WhatNoKnotHasIsNotNamed) {
  EXPECT_FALSE(name_of({9, 9}, {0, {7}}, 4));
  EXPECT_TRUE(candidates({9, 9}, {0, {7}}, 10).empty());
}

TEST(KnotTable, PartsOfASumStandInTheOrderOfTheTable) {
  EXPECT_EQ(sum_of({"8_10", "right"}, {"8_2", "right"}).type, "8_2#8_10");
  EXPECT_EQ(sum_of({"8_2", "right"}, {"3_1#4_1", "left"}).type, "3_1#4_1#8_2");
  EXPECT_EQ(sum_of({"8_2", "right"}, {"3_1", "left"}).handedness, "mixed");
}

TEST(KnotTable, NamesOfSurgeons) {
  EXPECT_EQ(common_name("3_1", "left"), "overhand");
  EXPECT_EQ(common_name("4_1", "amphichiral"), "figure-eight");
  EXPECT_EQ(common_name("3_1#3_1", "amphichiral"), "square");
  EXPECT_EQ(common_name("3_1#3_1", "left"), "granny");
  EXPECT_EQ(common_name("3_1#3_1", "right"), "granny");
  EXPECT_EQ(common_name("3_1#5_1", "mixed"), "surgeon's");
  EXPECT_EQ(common_name("3_1#5_1", "right"), "");
  EXPECT_EQ(common_name("5_1", "right"), "");
}

}  // namespace
}  // namespace ligature::knot
