#include "host/lab/published/throws.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "host/knot/recognise.hpp"

namespace ligature::published {
namespace {

using validate::Vec3;
using Line = std::vector<Vec3>;

constexpr double kPi = std::numbers::pi;

/// Points `step` apart along a polyline, as nearly as its length allows.
Line resampled(const Line& line, double step) {
  std::vector<double> along{0.0};
  for (std::size_t k = 1; k < line.size(); ++k) along.push_back(along.back() + (line[k] - line[k - 1]).norm());
  const auto count = static_cast<std::size_t>(std::max(2L, std::lround(along.back() / step)));
  Line out;
  for (std::size_t i = 0, k = 0; i <= count; ++i) {
    const double s = along.back() * static_cast<double>(i) / static_cast<double>(count);
    while (k + 2 < line.size() && along[k + 1] < s) ++k;
    out.push_back(line[k] + (s - along[k]) / std::max(along[k + 1] - along[k], 1e-300) * (line[k + 1] - line[k]));
  }
  return out;
}

/// Appends one strand of a throw to `line`: a helix about the throw's horizontal axis, which is at height z. The strand
/// enters on `side` (-1 left, +1 right) below the axis and leaves on the other side above it.
void wind(Line& line, const Throws& t, int half_turns, double half_width, double side, double z) {
  const double own = 0.5 * std::abs(half_turns) * t.half_turn_d;
  for (int k = 0; k <= 200; ++k) {
    const double x = side * half_width * (1.0 - 0.01 * k), u = std::clamp(0.5 * (x + own) / own, 0.0, 1.0);
    const double turn =
        u * u * u * (10.0 + u * (6.0 * u - 15.0));  // no slope at its ends, where the strand is straight
    const double angle = -0.5 * kPi + half_turns * kPi * turn + (side > 0.0 ? kPi : 0.0);
    line.emplace_back(x, t.aside_d * std::cos(angle), z + t.aside_d * std::sin(angle));
  }
}

/// From below the first throw, entered on `side`, through all throws to above the last one.
Line strand(const Throws& t, double half_width, double side) {
  Line line;
  for (std::size_t k = 0; k < t.half_turns.size(); ++k, side = -side) {
    const double z = t.between_d * static_cast<double>(k);
    if (k > 0) {  // a half circle outside of the throws
      const double radius = 0.5 * t.between_d - t.aside_d;
      for (int i = 1; i < 40; ++i) {
        const double a = kPi * i / 40.0;
        line.emplace_back(side * (half_width + radius * std::sin(a)), 0.0,
                          z - 0.5 * t.between_d - radius * std::cos(a));
      }
    }
    wind(line, t, t.half_turns[k], half_width, side, z);
  }
  return line;
}

/// A slack loop in front of the knot, between the points `from` and `to`. At both points the thread runs along -x.
void join(Line& line, const Vec3& from, const Vec3& to, double length) {
  const double across = to.x() - from.x(), radius = (length - across) / (2.0 * kPi);
  for (int i = 1; i < 400; ++i) {
    double s = length * i / 400.0;
    const double z = from.z() + (to.z() - from.z()) * i / 400.0;
    const auto arc = [&](double x, double side, double y) {
      const double a = s / radius;
      return Vec3(x - side * radius * std::sin(a), y - side * radius * (1.0 - std::cos(a)), z);
    };
    if (s < kPi * radius) {
      line.push_back(arc(from.x(), 1.0, 0.0));
      continue;
    }
    s -= kPi * radius;
    if (s < across) {
      line.emplace_back(from.x() + s, -2.0 * radius, z);
      continue;
    }
    s -= across;
    line.push_back(arc(to.x(), -1.0, -2.0 * radius));
  }
}

}  // namespace

Line rounded(const Line& line, double width, double step) {
  const Line fine = resampled(line, step);
  const auto n = static_cast<int>(fine.size()), reach = static_cast<int>(std::lround(3.0 * width / step));
  Line out;
  for (int i = 0; i < n; ++i) {
    const int most = std::min({reach, i, n - 1 - i});  // symmetric, so that the ends stay
    Vec3 sum = Vec3::Zero();
    double total = 0.0;
    for (int k = i - most; k <= i + most; ++k) {
      const double w = std::exp(-0.5 * std::pow((k - i) * step / width, 2));
      sum += w * fine[static_cast<std::size_t>(k)], total += w;
    }
    out.push_back(sum / total);
  }
  return resampled(out, step);
}

Line curve_of(const Throws& t, double diameter_m) {
  int most = 0;
  for (const int n : t.half_turns) most = std::max(most, std::abs(n));
  const double half_width = 0.5 * most * t.half_turn_d;
  Line first = strand(t, half_width, -1.0);
  const Line second = strand(t, half_width, 1.0);
  if (t.ends == Ends::kAbove) std::reverse(first.begin(), first.end());
  Line line = first;
  // The loop ends where the second strand begins; the second strand begins along -x.
  join(line, first.back(), second.front(), t.loop_d);
  line.insert(line.end(), second.begin(), second.end());
  if (line.front().x() > line.back().x()) std::reverse(line.begin(), line.end());
  line.insert(line.begin(), line.front() - t.tail_d * Vec3::UnitX());
  line.push_back(line.back() + t.tail_d * Vec3::UnitX());
  Line all = rounded(line, t.rounding_d, 0.5);
  for (auto& p : all) p *= diameter_m;
  return all;
}

void lay_curve(scene::Scene& scene, const Line& line) {
  double length = 0.0;
  for (std::size_t k = 1; k < line.size(); ++k) length += (line[k] - line[k - 1]).norm();
  scene.suture.length_m = length;
  scene.suture.initial = "laid";
  scene.suture.initial_polyline_m.clear();
  for (const auto& p : line) scene.suture.initial_polyline_m.push_back({p.x(), p.y(), p.z()});
}

std::string knot_in(std::span<const Vec3> nodes) {
  std::vector<std::array<double, 3>> points;
  for (const auto& p : nodes) points.push_back({p.x(), p.y(), p.z()});
  const auto found = knot::recognise(points, false);
  std::string name = found.type + " " + found.handedness;
  for (const int a : found.alexander) name += " " + std::to_string(a);  // an unnamed knot is known by its polynomial
  return name;
}

}  // namespace ligature::published
