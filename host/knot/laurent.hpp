#pragma once
// Integer Laurent polynomials, with just the operations that knot invariants need.

#include <compare>
#include <cstdint>
#include <vector>

namespace ligature::knot {

/// sum over k of c[k] x^(low + k). Zero is the empty vector; the first and last coefficients are never zero.
struct Laurent {
  int low = 0;
  std::vector<std::int64_t> c;

  auto operator<=>(const Laurent&) const = default;
};

inline void trim(Laurent& p) {
  while (!p.c.empty() && p.c.back() == 0) p.c.pop_back();
  std::size_t zeros = 0;
  while (zeros < p.c.size() && p.c[zeros] == 0) ++zeros;
  p.c.erase(p.c.begin(), p.c.begin() + static_cast<std::ptrdiff_t>(zeros));
  p.low = p.c.empty() ? 0 : p.low + static_cast<int>(zeros);
}

/// p += factor * x^shift * q
inline void add(Laurent& p, const Laurent& q, std::int64_t factor, int shift) {
  if (q.c.empty()) return;
  const int low = q.low + shift, high = low + static_cast<int>(q.c.size());
  if (p.c.empty()) p.low = low;
  if (low < p.low) {
    p.c.insert(p.c.begin(), static_cast<std::size_t>(p.low - low), 0);
    p.low = low;
  }
  if (high > p.low + static_cast<int>(p.c.size())) p.c.resize(static_cast<std::size_t>(high - p.low), 0);
  for (std::size_t k = 0; k < q.c.size(); ++k) p.c[static_cast<std::size_t>(low - p.low) + k] += factor * q.c[k];
  trim(p);
}

[[nodiscard]] inline Laurent product(const Laurent& p, const Laurent& q) {
  Laurent r;
  for (std::size_t k = 0; k < p.c.size(); ++k) add(r, q, p.c[k], p.low + static_cast<int>(k));
  return r;
}

/// p(1/x): the Jones polynomial of the mirror image.
[[nodiscard]] inline Laurent mirrored(const Laurent& p) {
  if (p.c.empty()) return p;
  return {-(p.low + static_cast<int>(p.c.size()) - 1), {p.c.rbegin(), p.c.rend()}};
}

}  // namespace ligature::knot
