#include "host/lab/published/writhe.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace ligature::published {
namespace {

using physics::rod::Vec;

double arc_sine(Vec a, Vec b) { return std::asin(std::clamp(dot(a, b), -1.0, 1.0)); }

/// Signed solid angle that segments a0 a1 and b0 b1 contribute, over 4 pi.
double pair(Vec a0, Vec a1, Vec b0, Vec b1) {
  const Vec r00 = b0 - a0, r01 = b1 - a0, r10 = b0 - a1, r11 = b1 - a1;
  Vec n[4] = {cross(r00, r01), cross(r01, r11), cross(r11, r10), cross(r10, r00)};
  for (auto& v : n) {
    const double size = norm(v);
    if (size < 1e-300) return 0.0;  // in one plane
    v = (1.0 / size) * v;
  }
  const double area = arc_sine(n[0], n[1]) + arc_sine(n[1], n[2]) + arc_sine(n[2], n[3]) + arc_sine(n[3], n[0]);
  const double sign = dot(cross(b1 - b0, a1 - a0), r00);
  return sign == 0.0 ? 0.0 : std::copysign(area, sign) / (4.0 * std::numbers::pi);
}

}  // namespace

double writhe(const std::vector<Vec>& x) {
  double sum = 0.0;
  for (std::size_t i = 0; i + 1 < x.size(); ++i) {
    for (std::size_t j = i + 2; j + 1 < x.size(); ++j) sum += 2.0 * pair(x[i], x[i + 1], x[j], x[j + 1]);
  }
  return sum;
}

}  // namespace ligature::published
