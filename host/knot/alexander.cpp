#include "host/knot/alexander.hpp"

#include <cstdint>
#include <cstdlib>

namespace ligature::knot {
namespace {

constexpr std::uint64_t kPrime = (std::uint64_t{1} << 61) - 1;
__extension__ using Wide = unsigned __int128;

std::uint64_t times(std::uint64_t a, std::uint64_t b) {
  return static_cast<std::uint64_t>(static_cast<Wide>(a) * b % kPrime);
}
std::uint64_t plus(std::uint64_t a, std::uint64_t b) { return (a + b) % kPrime; }
std::uint64_t minus(std::uint64_t a, std::uint64_t b) { return (a + kPrime - b) % kPrime; }

std::uint64_t inverse(std::uint64_t a) {  // Fermat's little theorem: a^(p - 2)
  std::uint64_t r = 1;
  for (std::uint64_t e = kPrime - 2; e > 0; e >>= 1, a = times(a, a)) {
    if (e & 1) r = times(r, a);
  }
  return r;
}

using Matrix = std::vector<std::vector<std::uint64_t>>;

std::uint64_t determinant_of(Matrix m) {
  const std::size_t n = m.size();
  std::uint64_t det = 1;
  for (std::size_t c = 0; c < n; ++c) {
    std::size_t pivot = c;
    while (pivot < n && m[pivot][c] == 0) ++pivot;
    if (pivot == n) return 0;
    if (pivot != c) {
      std::swap(m[pivot], m[c]);
      det = minus(0, det);
    }
    det = times(det, m[c][c]);
    const auto scale = inverse(m[c][c]);
    for (std::size_t r = c + 1; r < n; ++r) {
      if (m[r][c] == 0) continue;
      const auto factor = times(m[r][c], scale);
      for (std::size_t k = c; k < n; ++k) m[r][k] = minus(m[r][k], times(factor, m[c][k]));
    }
  }
  return det;
}

/// The three arcs that meet at a crossing. An arc runs from one under-pass to the next.
struct Arcs {
  std::size_t over, in, out;
};

std::vector<Arcs> arcs_of(const Diagram& d) {
  std::vector<Arcs> arcs(d.crossings());
  std::size_t arc = 0;
  for (const auto& p : d.passes) {
    if (p.over) {
      arcs[p.crossing].over = arc;
    } else {
      arcs[p.crossing].in = arc;
      arc = (arc + 1) % d.crossings();
      arcs[p.crossing].out = arc;
    }
  }
  return arcs;
}

std::uint64_t minor_at(const Diagram& d, const std::vector<Arcs>& arcs, std::uint64_t t) {
  const std::size_t n = d.crossings() - 1;  // a minor: the last row and column are left out; any others would do
  Matrix m(n, std::vector<std::uint64_t>(n, 0));
  for (std::size_t c = 0; c < n; ++c) {
    const auto put = [&](std::size_t arc, std::uint64_t v) {
      if (arc < n) m[c][arc] = plus(m[c][arc], v);
    };
    const bool right = d.signs[c] > 0;
    put(arcs[c].over, minus(1, t));
    put(right ? arcs[c].in : arcs[c].out, t);
    put(right ? arcs[c].out : arcs[c].in, minus(0, 1));
  }
  return determinant_of(std::move(m));
}

/// Coefficients of the polynomial of degree < y.size() with p(k) = y[k] (Newton's divided differences, then expanded).
std::vector<std::uint64_t> interpolate(std::vector<std::uint64_t> y) {
  const std::size_t n = y.size();
  for (std::size_t level = 1; level < n; ++level) {
    const auto scale = inverse(level);
    for (std::size_t k = n - 1; k >= level; --k) y[k] = times(minus(y[k], y[k - 1]), scale);
  }
  std::vector<std::uint64_t> p(n, 0);
  for (std::size_t k = n; k-- > 0;) {  // p = p (x - k) + y[k]
    for (std::size_t i = n; i-- > 0;) p[i] = minus(i > 0 ? p[i - 1] : 0, times(p[i], k));
    p[0] = plus(p[0], y[k]);
  }
  return p;
}

}  // namespace

std::vector<int> alexander(const Diagram& d) {
  if (d.crossings() < 3) return {1};
  const auto arcs = arcs_of(d);
  std::vector<std::uint64_t> values;
  values.reserve(d.crossings());
  for (std::size_t t = 0; t < d.crossings(); ++t) values.push_back(minor_at(d, arcs, t));
  std::vector<int> c;
  for (const auto residue : interpolate(std::move(values))) {
    const auto value =
        residue > kPrime / 2 ? -static_cast<std::int64_t>(kPrime - residue) : static_cast<std::int64_t>(residue);
    if (!c.empty() || value != 0) c.push_back(static_cast<int>(value));
  }
  while (!c.empty() && c.back() == 0) c.pop_back();
  if (!c.empty() && c.front() < 0) {
    for (auto& value : c) value = -value;
  }
  return c;
}

int determinant(const std::vector<int>& alexander) noexcept {
  int at_minus_one = 0;
  for (std::size_t k = 0; k < alexander.size(); ++k) at_minus_one += k % 2 == 0 ? alexander[k] : -alexander[k];
  return std::abs(at_minus_one);
}

}  // namespace ligature::knot
