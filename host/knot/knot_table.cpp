#include "host/knot/knot_table.hpp"

#include <algorithm>
#include <map>
#include <sstream>
#include <utility>

namespace ligature::knot {
namespace {

struct Prime {
  const char* type;
  std::size_t crossings;
  bool chiral;
  std::vector<int> alexander;
  Laurent jones;  ///< Jones polynomial of the right-handed form
};

/// The table of prime knots (Rolfsen's numbering). A test derives each row again from a diagram.
const std::vector<Prime>& primes() {
  static const std::vector<Prime> kPrimes{
      {"3_1", 3, true, {1, -1, 1}, {1, {1, 0, 1, -1}}},
      {"4_1", 4, false, {1, -3, 1}, {-2, {1, -1, 1, -1, 1}}},
      {"5_1", 5, true, {1, -1, 1, -1, 1}, {2, {1, 0, 1, -1, 1, -1}}},
      {"5_2", 5, true, {2, -3, 2}, {1, {1, -1, 2, -1, 1, -1}}},
      {"6_1", 6, true, {2, -5, 2}, {-2, {1, -1, 2, -2, 1, -1, 1}}},
      {"6_2", 6, true, {1, -3, 3, -3, 1}, {-1, {1, -1, 2, -2, 2, -2, 1}}},
      {"6_3", 6, false, {1, -3, 5, -3, 1}, {-3, {-1, 2, -2, 3, -2, 2, -1}}},
      {"7_1", 7, true, {1, -1, 1, -1, 1, -1, 1}, {3, {1, 0, 1, -1, 1, -1, 1, -1}}},
      {"7_2", 7, true, {3, -5, 3}, {1, {1, -1, 2, -2, 2, -1, 1, -1}}},
      {"7_3", 7, true, {2, -3, 3, -3, 2}, {2, {1, -1, 2, -2, 3, -2, 1, -1}}},
      {"7_4", 7, true, {4, -7, 4}, {1, {1, -2, 3, -2, 3, -2, 1, -1}}},
      {"7_5", 7, true, {2, -4, 5, -4, 2}, {2, {1, -1, 3, -3, 3, -3, 2, -1}}},
      {"7_6", 7, true, {1, -5, 7, -5, 1}, {-1, {1, -2, 3, -3, 4, -3, 2, -1}}},
      {"7_7", 7, true, {1, -5, 9, -5, 1}, {-3, {-1, 3, -3, 4, -4, 3, -2, 1}}},
  };
  return kPrimes;
}

constexpr std::size_t kMostCrossings = 10;
constexpr std::size_t kUnknotCrossings = 24;

/// {name, crossings}: from this many crossings on, another knot has both polynomials of the named one: 10_132 those of
/// 5_1, and 9_12 those of 4_1#5_2.
constexpr std::pair<const char*, std::size_t> kShared[] = {{"5_1", 10}, {"4_1#5_2", 9}};

using Invariants = std::pair<std::vector<int>, Laurent>;
using Table = std::map<Invariants, KnotName>;

std::string joined_hand(const std::string& a, const std::string& b) {
  if (a == "none" || a == "amphichiral") return b == "none" ? a : b;
  if (b == "amphichiral") return a;
  return a == b ? a : "mixed";
}

/// Adds to the table every connected sum of `sum` with prime knots from index `first` on, right- and left-handed, up to
/// kMostCrossings crossings.
void extend(Table& table, const Invariants& sum, const KnotName& name, std::size_t first, std::size_t crossings) {
  for (std::size_t k = first; k < primes().size(); ++k) {
    const auto& p = primes()[k];
    if (crossings + p.crossings > kMostCrossings) continue;
    for (const bool right : {true, false}) {
      if (!right && !p.chiral) continue;
      std::vector<int> a(sum.first.size() + p.alexander.size() - 1, 0);
      for (std::size_t i = 0; i < a.size(); ++i) {
        for (std::size_t j = 0; j < p.alexander.size() && j <= i; ++j) {
          if (i - j < sum.first.size()) a[i] += sum.first[i - j] * p.alexander[j];
        }
      }
      const Invariants next{a, product(sum.second, right ? p.jones : mirrored(p.jones))};
      const std::string hand = !p.chiral ? "amphichiral" : right ? "right" : "left";
      const KnotName longer{name.type.empty() ? p.type : name.type + "#" + p.type, joined_hand(name.handedness, hand)};
      table.emplace(next, longer);
      extend(table, next, longer, k, crossings + p.crossings);
    }
  }
}

/// All names of the table. A sum whose Jones polynomial equals its mirror image's is amphichiral, even though its parts
/// have different hands.
Table make_table() {
  Table table;
  extend(table, {{1}, {0, {1}}}, {"", "none"}, 0, 0);
  for (auto& [invariants, name] : table) {
    if (name.handedness == "mixed" && invariants.second == mirrored(invariants.second)) name.handedness = "amphichiral";
  }
  return table;
}

}  // namespace

std::optional<KnotName> name_of(const std::vector<int>& alexander, const Laurent& jones, std::size_t crossings) {
  static const Table kTable = make_table();
  if (crossings <= kUnknotCrossings && jones == Laurent{0, {1}}) return KnotName{"0_1", "none"};
  if (crossings > kMostCrossings) return std::nullopt;
  const auto found = kTable.find({alexander, jones});
  if (found == kTable.end()) return std::nullopt;
  for (const auto& [type, from] : kShared) {
    if (found->second.type == type && crossings >= from) return std::nullopt;
  }
  return found->second;
}

KnotName sum_of(const KnotName& a, const KnotName& b) {
  if (a.type == "0_1") return b;
  if (b.type == "0_1") return a;
  std::vector<std::string> parts;
  for (const auto& name : {a.type, b.type}) {
    std::istringstream text(name);
    for (std::string part; std::getline(text, part, '#');) parts.push_back(part);
  }
  // all crossing numbers have one digit, so that alphabetical order is the order of the table
  std::sort(parts.begin(), parts.end());
  std::string type;
  for (const auto& part : parts) type += (type.empty() ? "" : "#") + part;
  return {type, joined_hand(a.handedness, b.handedness)};
}

}  // namespace ligature::knot
