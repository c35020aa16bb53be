#include "host/knot/diagram.hpp"

#include <algorithm>
#include <limits>
#include <numeric>

namespace ligature::knot {
namespace {

/// Deletes crossings a and b and renumbers the rest.
void erase(Diagram& d, std::size_t a, std::size_t b) {
  constexpr auto kGone = std::numeric_limits<std::size_t>::max();
  std::vector<std::size_t> renamed(d.crossings(), kGone);
  std::vector<int> signs;
  for (std::size_t c = 0; c < d.crossings(); ++c) {
    if (c == a || c == b) continue;
    renamed[c] = signs.size();
    signs.push_back(d.signs[c]);
  }
  std::erase_if(d.passes, [&](const Pass& p) { return renamed[p.crossing] == kGone; });
  for (auto& p : d.passes) p.crossing = renamed[p.crossing];
  d.signs = std::move(signs);
}

/// Removes a nugatory crossing c: the walk along the knot is c A c B, where the pieces A and B have no crossing in
/// common. Turning A by 180 degrees removes c. A's crossings keep their signs, and their over and under passes swap.
bool undo_one_nugatory(Diagram& d) {
  const std::size_t n = d.passes.size();
  for (std::size_t i = 0; i < n; ++i) {
    std::vector<int> seen(d.crossings(), 0);
    int open = 0;
    for (std::size_t j = i + 1; j < n; ++j) {
      const auto c = d.passes[j].crossing;
      if (c == d.passes[i].crossing) {
        if (open != 0) break;
        for (std::size_t k = i + 1; k < j; ++k) d.passes[k].over = !d.passes[k].over;
        erase(d, c, c);
        return true;
      }
      open += seen[c]++ == 0 ? 1 : -1;
    }
  }
  return false;
}

/// Removes a pair of crossings of opposite sign that are neighbours both on the over strand and on the under strand
/// (Reidemeister II).
bool undo_one_clasp(Diagram& d) {
  const std::size_t n = d.passes.size();
  if (n < 4) return false;
  std::vector<std::size_t> at_under(d.crossings());
  for (std::size_t i = 0; i < n; ++i) {
    if (!d.passes[i].over) at_under[d.passes[i].crossing] = i;
  }
  for (std::size_t i = 0; i < n; ++i) {
    const Pass &p = d.passes[i], &q = d.passes[(i + 1) % n];
    if (!p.over || !q.over || d.signs[p.crossing] == d.signs[q.crossing]) continue;
    const std::size_t u = at_under[p.crossing], v = at_under[q.crossing];
    if ((u + 1) % n != v && (v + 1) % n != u) continue;
    erase(d, p.crossing, q.crossing);
    return true;
  }
  return false;
}

/// The sub-diagram made of some of d's passes. Each of its crossings must occur twice among them.
Diagram part_of(const Diagram& d, std::vector<Pass> passes) {
  Diagram part{std::move(passes), {}};
  std::vector<std::size_t> renamed(d.crossings(), d.crossings());
  for (auto& p : part.passes) {
    auto& name = renamed[p.crossing];
    if (name == d.crossings()) {
      name = part.signs.size();
      part.signs.push_back(d.signs[p.crossing]);
    }
    p.crossing = name;
  }
  return part;
}

}  // namespace

int writhe(const Diagram& d) noexcept { return std::accumulate(d.signs.begin(), d.signs.end(), 0); }

void reduce(Diagram& d) {
  while (undo_one_nugatory(d) || undo_one_clasp(d)) {
  }
}

std::vector<Diagram> visible_factors(const Diagram& d) {
  const std::size_t n = d.passes.size();
  for (std::size_t i = 0; i < n; ++i) {
    std::vector<int> seen(d.crossings(), 0);
    int open = 0;
    for (std::size_t j = i; j < n; ++j) {
      open += seen[d.passes[j].crossing]++ == 0 ? 1 : -1;
      const std::size_t length = j + 1 - i;
      if (open != 0 || length == n) continue;
      const auto first = d.passes.begin() + static_cast<std::ptrdiff_t>(i),
                 last = d.passes.begin() + static_cast<std::ptrdiff_t>(j + 1);
      std::vector<Pass> rest(d.passes.begin(), first);
      rest.insert(rest.end(), last, d.passes.end());
      auto factors = visible_factors(part_of(d, {first, last}));
      for (auto& f : visible_factors(part_of(d, std::move(rest)))) factors.push_back(std::move(f));
      return factors;
    }
  }
  return {d};
}

}  // namespace ligature::knot
