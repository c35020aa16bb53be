#include "host/knot/knot_table.hpp"

#include <algorithm>
#include <map>
#include <sstream>
#include <utility>

#include "host/knot/nine_and_ten.hpp"

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
      {"8_1", 8, true, {3, -7, 3}, {-2, {1, -1, 2, -2, 2, -2, 1, -1, 1}}},
      {"8_2", 8, true, {1, -3, 3, -3, 3, -3, 1}, {0, {1, -1, 2, -2, 3, -3, 2, -2, 1}}},
      {"8_3", 8, false, {4, -9, 4}, {-4, {1, -1, 2, -3, 3, -3, 2, -1, 1}}},
      {"8_4", 8, true, {2, -5, 5, -5, 2}, {-3, {1, -1, 2, -3, 3, -3, 3, -2, 1}}},
      {"8_5", 8, true, {1, -3, 4, -5, 4, -3, 1}, {0, {1, -1, 3, -3, 3, -4, 3, -2, 1}}},
      {"8_6", 8, true, {2, -6, 7, -6, 2}, {-1, {1, -1, 3, -4, 4, -4, 3, -2, 1}}},
      {"8_7", 8, true, {1, -3, 5, -5, 5, -3, 1}, {-2, {-1, 2, -2, 4, -4, 4, -3, 2, -1}}},
      {"8_8", 8, true, {2, -6, 9, -6, 2}, {-3, {-1, 2, -3, 5, -4, 4, -3, 2, -1}}},
      {"8_9", 8, false, {1, -3, 5, -7, 5, -3, 1}, {-4, {1, -2, 3, -4, 5, -4, 3, -2, 1}}},
      {"8_10", 8, true, {1, -3, 6, -7, 6, -3, 1}, {-2, {-1, 2, -3, 5, -4, 5, -4, 2, -1}}},
      {"8_11", 8, true, {2, -7, 9, -7, 2}, {-1, {1, -2, 4, -4, 5, -5, 3, -2, 1}}},
      {"8_12", 8, false, {1, -7, 13, -7, 1}, {-4, {1, -2, 4, -5, 5, -5, 4, -2, 1}}},
      {"8_13", 8, true, {2, -7, 11, -7, 2}, {-3, {-1, 3, -4, 5, -5, 5, -3, 2, -1}}},
      {"8_14", 8, true, {2, -8, 11, -8, 2}, {-1, {1, -2, 4, -5, 6, -5, 4, -3, 1}}},
      {"8_15", 8, true, {3, -8, 11, -8, 3}, {2, {1, -2, 5, -5, 6, -6, 4, -3, 1}}},
      {"8_16", 8, true, {1, -4, 8, -9, 8, -4, 1}, {-2, {-1, 3, -4, 6, -6, 6, -5, 3, -1}}},
      {"8_17", 8, false, {1, -4, 8, -11, 8, -4, 1}, {-4, {1, -3, 5, -6, 7, -6, 5, -3, 1}}},
      {"8_18", 8, false, {1, -5, 10, -13, 10, -5, 1}, {-4, {1, -4, 6, -7, 9, -7, 6, -4, 1}}},
      {"8_19", 8, true, {1, -1, 0, 1, 0, -1, 1}, {3, {1, 0, 1, 0, 0, -1}}},
      {"8_20", 8, true, {1, -2, 3, -2, 1}, {-1, {-1, 2, -1, 2, -1, 1, -1}}},
      {"8_21", 8, true, {1, -4, 5, -4, 1}, {1, {2, -2, 3, -3, 2, -2, 1}}},
  };
  return kPrimes;
}

constexpr std::size_t kMostCrossings = 10;
constexpr std::size_t kUnknotCrossings = 24;

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

const Table& table() {
  static const Table kTable = make_table();
  return kTable;
}

}  // namespace

std::vector<std::string> candidates(const std::vector<int>& alexander, const Laurent& jones, std::size_t crossings) {
  if (crossings > kMostCrossings) return {};
  std::vector<std::string> types;
  if (const auto found = table().find({alexander, jones}); found != table().end()) types.push_back(found->second.type);
  for (auto& type : of_nine_and_ten(alexander, jones, crossings)) types.push_back(std::move(type));
  return types;
}

std::optional<KnotName> name_of(const std::vector<int>& alexander, const Laurent& jones, std::size_t crossings) {
  if (crossings <= kUnknotCrossings && jones == Laurent{0, {1}}) return KnotName{"0_1", "none"};
  if (crossings > kMostCrossings) return std::nullopt;
  const auto found = table().find({alexander, jones});
  if (found == table().end() || !of_nine_and_ten(alexander, jones, crossings).empty()) return std::nullopt;
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
  const auto place = [](const std::string& part) {  // in the table: 8_2 stands before 8_10
    const auto bar = part.find('_');
    return std::pair{std::stoi(part.substr(0, bar)), std::stoi(part.substr(bar + 1))};
  };
  std::sort(parts.begin(), parts.end(), [&](const auto& x, const auto& y) { return place(x) < place(y); });
  std::string type;
  for (const auto& part : parts) type += (type.empty() ? "" : "#") + part;
  return {type, joined_hand(a.handedness, b.handedness)};
}

}  // namespace ligature::knot
