#include "host/view/knot_core.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

namespace ligature::host::view {
namespace {

using Points = std::span<const std::array<double, 3>>;

Points piece_of(Points points, KnotCore at) { return points.subspan(at.first, at.last - at.first + 1); }

/// Prime knots of a type, e.g. {"3_1", "5_1"}, sorted.
std::vector<std::string> summands_of(const std::string& type) {
  std::vector<std::string> found;
  for (std::size_t begin = 0; begin <= type.size();) {
    const auto end = std::min(type.find('#', begin), type.size());
    found.push_back(type.substr(begin, end - begin));
    begin = end + 1;
  }
  std::ranges::sort(found);
  return found;
}

/// The short piece of points[at] that contains its knot; nothing when there is no knot.
std::optional<KnotCore> core_in(Points points, KnotCore at) {
  if (at.last < at.first + 4) return std::nullopt;
  const Points piece = piece_of(points, at);
  const KnotCore found = find_core(piece, knot::recognise(piece, false));
  if (found.last == 0) return std::nullopt;
  return KnotCore{at.first + found.first, at.first + found.last};
}

std::string type_in(Points points, KnotCore at) {
  return at.last < at.first + 4 ? "0_1" : knot::recognise(piece_of(points, at), false).type;
}

/// Finds the cut behind the first throw: one of the knot's prime summands lies before the cut, the others behind it.
/// @return the node of the cut; nothing when there is no such cut.
std::optional<std::size_t> first_cut(Points points, KnotCore at, const std::vector<std::string>& summands) {
  const auto is_cut = [&](std::size_t cut) {
    auto both = summands_of(type_in(points, {cut, at.last}));
    both.push_back(type_in(points, {at.first, cut}));
    std::ranges::sort(both);
    return both == summands;
  };
  const auto bisect = [&](const auto& is_enough) {  // smallest cut for which it holds
    std::size_t low = at.first, high = at.last;
    while (low + 1 < high) {
      const std::size_t middle = (low + high) / 2;
      (is_enough(middle) ? high : low) = middle;
    }
    return high;
  };
  // the cut lies after the first place at which a knot is complete, and before the last place after which a knot
  // follows
  const std::size_t earliest = bisect([&](std::size_t cut) { return type_in(points, {at.first, cut}) != "0_1"; });
  const std::size_t latest = bisect([&](std::size_t cut) { return type_in(points, {cut, at.last}) == "0_1"; }) - 1;
  // A cut through a loose knot can give any type, so that several places are tried, from the middle outwards.
  const double middle = 0.5 * static_cast<double>(earliest + latest);
  const double half = middle - static_cast<double>(std::min(earliest, latest));
  for (const double share : {0.0, 0.5, -0.5, 0.25, -0.25, 0.75, -0.75, 1.0, -1.0}) {
    const auto cut = static_cast<std::size_t>(std::lround(middle + share * half));
    if (cut > at.first && cut < at.last && is_cut(cut)) return cut;
  }
  return std::nullopt;
}

}  // namespace

KnotCore find_core(Points points, const knot::KnotResult& whole) {
  if (whole.type == "0_1" || whole.type == "unknown" || points.size() < 5) return {};
  const auto is_same = [&](std::size_t first, std::size_t last) {
    const auto piece = knot::recognise(points.subspan(first, last - first + 1), false);
    return piece.type == whole.type && piece.handedness == whole.handedness;
  };
  KnotCore core{0, points.size() - 1};
  // bisection for the smallest last node that keeps the knot
  for (std::size_t low = core.first, high = core.last; low + 1 < high;) {
    const std::size_t middle = (low + high) / 2;
    (is_same(0, middle) ? high : low) = middle;
    core.last = high;
  }
  for (std::size_t low = 0, high = core.last; low + 1 < high;) {
    const std::size_t middle = (low + high) / 2;
    (is_same(middle, core.last) ? low : high) = middle;
    core.first = low;
  }
  return core;
}

std::vector<KnotCore> find_throws(Points points, const knot::KnotResult& whole, KnotCore core) {
  if (core.last == 0) return {};
  std::vector<KnotCore> found;
  auto summands = summands_of(whole.type);
  // The search starts with the whole thread, including its long ends: a piece that is cut close to the knot on both
  // sides is recognised less reliably.
  for (KnotCore rest{0, points.size() - 1}; summands.size() > 1;) {
    const auto cut = first_cut(points, rest, summands);
    const auto one = cut ? core_in(points, {rest.first, *cut}) : std::nullopt;
    if (!one) return {core};
    summands.erase(std::ranges::find(summands, type_in(points, {rest.first, *cut})));
    found.push_back(*one);
    rest.first = *cut;
    if (summands.size() > 1) continue;
    const auto last = core_in(points, rest);
    if (!last) return {core};
    found.push_back(*last);
  }
  return found.empty() ? std::vector{core} : found;
}

}  // namespace ligature::host::view
