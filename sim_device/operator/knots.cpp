#include "sim_device/operator/knots.hpp"

#include <algorithm>
#include <array>

namespace ligature::sim {
namespace {

constexpr Throw kOverhand[]{{1, false, 1}};

constexpr std::array<Knot, 1> kKnots{{{"overhand", "3_1", kOverhand}}};

const Vec3 kSlant = Vec3(-0.75, 0.0, -0.66).normalized();  // the standing part runs down to the left

const Vec3 kDown = Vec3(-0.1, 0.0, -1.0).normalized();

constexpr double kWatch_s = 5.0;  // after letting go: does it stay?

WhereAlong the_end() {
  return [](const Look& look) { return look.thread.length_m(); };
}

/// The knots that are there: first and last place where the thread touches another part of itself.
struct Tangle {
  double first = 0.0, last = 0.0;
};

Tangle tangle(const Look& look) {
  const double step = look.place.diameter_m, apart = 6.0 * look.place.diameter_m, all = look.thread.length_m();
  std::vector<Vec3> points;
  for (double s = 0.0; s < all; s += step) points.push_back(look.thread.at(s));
  Tangle t{all, 0.0};
  const auto skip = static_cast<std::size_t>(apart / step);
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t j = i + skip; j < points.size(); ++j) {
      if ((points[i] - points[j]).norm() > 2.0 * look.place.diameter_m) continue;
      t.first = std::min(t.first, step * static_cast<double>(i));
      t.last = std::max(t.last, step * static_cast<double>(j));
    }
  }
  return t;
}

/// Takes the corner at `s` with the left hand and holds it so that the standing part runs straight down to the left.
void take_corner(Moves& m, const Workplace& place, WhereAlong s) {
  m.push_back(reach(kLeftHand, s));
  m.push_back(pinch(kLeftHand));
  m.push_back(carry(kLeftHand, "hold the corner", [anchor = place.anchor_W, s](const Look& look) -> Vec3 {
    return anchor + 0.96 * s(look) * kSlant;
  }));
}

}  // namespace

std::span<const Knot> knots() { return kKnots; }

std::optional<Knot> knot_named(std::string_view name) {
  for (const Knot& k : kKnots)
    if (k.name == name) return k;
  return std::nullopt;
}

Moves plan(const Knot& knot, const Workplace& place) {
  Moves m;
  auto corner = std::make_shared<double>((knot.throws.size() > 1 ? 0.3 : 0.4) * place.length_m);
  const WhereAlong at_corner = [corner](const Look&) { return *corner; };
  auto turn = std::make_shared<double>(0.5 * *corner);
  for (std::size_t k = 0; k < knot.throws.size(); ++k) {
    const Throw& t = knot.throws[k];
    if (k > 0) {
      m.push_back({"see the knot", [corner, turn](const Look& look) {
                     const Tangle knotted = tangle(look);
                     *corner = knotted.last + 0.02 * look.place.length_m;
                     *turn = 0.6 * knotted.first;
                     return true;
                   }});
    }
    take_corner(m, place, at_corner);
    if (k == 0) {
      m.push_back(reach(kRightHand, the_end()));
      m.push_back(pinch(kRightHand));
    }
    auto loop = std::make_shared<Loop>(at_corner, t.side);
    const WhereAlong at_turn = [turn](const Look&) { return *turn; };
    append(m, lay_turn(loop, at_turn));
    append(m, pass_through(loop, t, at_turn));
    m.push_back(draw_through(loop, kSlant));
    m.push_back(let_go(kLeftHand));
    append(m, pull_tight(kSlant, 0.7));
    m.push_back(swing(kDown));
    append(m, pull_tight(kDown, 1.0));
    m.push_back(wait(0.3));
    m.push_back(ease());
  }
  m.push_back(let_go(kRightHand));
  m.push_back(wait(kWatch_s));
  return m;
}

}  // namespace ligature::sim
