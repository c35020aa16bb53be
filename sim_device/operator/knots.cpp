#include "sim_device/operator/knots.hpp"

#include <algorithm>
#include <array>
#include <memory>

#include "sim_device/operator/diagram.hpp"
#include "sim_device/operator/figure_eight.hpp"
#include "sim_device/operator/primitives.hpp"
#include "sim_device/operator/springy_throw.hpp"
#include "sim_device/operator/untie.hpp"
#include "sim_device/operator/wound_throw.hpp"

namespace ligature::sim {
namespace {

constexpr Throw kOverhand[]{{1, false, 1}};
constexpr Throw kFigureEight[]{{1, true, 1}};

constexpr Throw kSquare[]{{1, false, 1}, {-1, false, 1}};
constexpr Throw kGranny[]{{-1, false, 1}, {-1, false, 1}};
constexpr Throw kSurgeon[]{{1, false, 2}, {-1, false, 1}};

constexpr std::array kKnots{
    Knot{"overhand", "3_1", "right", kOverhand, 0.0, 2.65},  Knot{"figure-eight", "4_1", "amphichiral", kFigureEight},
    Knot{"square", "3_1#3_1", "amphichiral", kSquare, 45.0}, Knot{"granny", "3_1#3_1", "left", kGranny, 45.0},
    Knot{"surgeon", "3_1#5_1", "mixed", kSurgeon, 60.0},
};

const Vec3 kSlant = Vec3(-0.75, 0.0, -0.66).normalized();  // direction past the corner, down to the left
const Vec3 kDown = Vec3(-0.1, 0.0, -1.0).normalized();

const Vec3 kSeenFrom = -Vec3::UnitY();

constexpr double kWatch_s = 5.0;  // waiting time after the last release, to see whether the knot stays

WhereAlong the_end() {
  return [](const Look& look) { return look.thread.length_m(); };
}

/// Layout of a single throw. `corner`: where the left hand holds the thread, as a fraction of its length; the standing
/// part is the thread from the anchor to there. `stretch`: horizontal distance of the corner from the anchor, to the
/// left, as a fraction of the standing part's length. `turn`: place on the standing part where the end goes around, as
/// a fraction of the standing part's length.
struct Layout {
  double corner, stretch, turn;
};

/// A limp thread is held so that its standing part sags between anchor and corner: then the turn of a figure-eight
/// stays at the lowest point while the end passes the loop, instead of slipping over the corner. A springy thread is
/// held nearly taut.
Layout layout_of(const Throw& t, bool springy) {
  if (!springy) return {0.403, 0.866, 0.49};
  return t.against ? Layout{0.35, 0.96, 0.45} : Layout{0.4, 0.96, 0.5};
}

/// Length of thread that is used up by knots between the anchor and place `s`, m.
double taken_up(const Look& look, double s) {
  const Tangle knotted = tangle(look);
  if (knotted.first_m >= knotted.last_m || knotted.last_m > s) return 0.0;
  return knotted.last_m - knotted.first_m - (look.thread.at(knotted.last_m) - look.thread.at(knotted.first_m)).norm();
}

/// The left hand holds place `s` at the position given by the layout.
Move hold_corner(const Workplace& place, const Layout& layout, const WhereAlong& s) {
  return carry(kLeftHand, "hold the corner", [anchor = place.anchor_W, layout, s](const Look& look) -> Vec3 {
    return anchor + layout.stretch * (s(look) - taken_up(look, s(look))) * -Vec3::UnitX();
  });
}

/// The right hand holds the end down with the thread just straight. Otherwise the thread beside a knot would hang at an
/// angle, and the left hand's jaws would keep that angle when they close.
Moves hold_down() {
  constexpr double kStraight = 0.1;  // fraction of a tight knot's pull
  Moves m{take(kRightHand, the_end())};
  append(m, pull_tight(kDown, kStraight));
  return m;
}

}  // namespace

std::span<const Knot> knots() { return kKnots; }

std::string knot_names() {
  std::string names;
  for (const Knot& k : kKnots) names += (names.empty() ? "" : ", ") + std::string(k.name);
  return names;
}

std::optional<Knot> knot_named(std::string_view name) {
  if (name == "surgeon's" || name == "surgeons") name = "surgeon";
  for (const Knot& k : kKnots)
    if (k.name == name) return k;
  return std::nullopt;
}

namespace {

/// For one throw of several: positions along the thread, m, of the corner and of the place where the end crosses over
/// the standing part. The first throw is near the anchor, each further one beyond the existing knot.
struct Places {
  double corner = 0.0, turn = 0.0;
};

Move see_the_places(const std::shared_ptr<Places>& places) {
  constexpr double kFirst = 0.3, kBeyond = 0.18, kMost = 0.6, kTurnAt = 0.5, kTurnBeyond = 0.4;
  return {"see the knot", [=](const Look& look) {
            const double knotted = tangle(look).last_m, all = look.thread.length_m();
            const bool is_first = !(knotted > 0.0);
            const double corner = is_first ? kFirst * all : std::min(knotted + kBeyond * all, kMost * all);
            const double base = std::min(knotted, corner);
            *places = {corner, base + (is_first ? kTurnAt : kTurnBeyond) * (corner - base)};
            return true;
          }};
}

/// One throw, with the corner held by the left hand, drawn tight; both hands are empty at the end.
Moves held_throw(const Throw& t, const Workplace& place, bool alone) {
  const bool springy = is_springy(place);
  const Layout layout = layout_of(t, springy);
  const double first = layout.corner * place.length_m;
  auto places = std::make_shared<Places>(Places{first, layout.turn * first});
  const WhereAlong at_corner = [places](const Look&) { return places->corner; };
  const WhereAlong at_turn = [places](const Look&) { return places->turn; };
  Moves m;
  const bool is_later = t.tied_already > 1;
  if (is_later) append(m, hold_down());
  if (!alone) m.push_back(see_the_places(places));
  m.push_back(take(kLeftHand, at_corner));
  if (is_later) m.push_back(let_go(kRightHand));
  m.push_back(hold_corner(place, layout, at_corner));
  m.push_back(take(kRightHand, the_end()));
  auto loop = std::make_shared<Loop>(at_corner, t.side);
  if (springy) {
    m.push_back(open_arch(t, at_corner));
    m.push_back(springy_throw(t, at_corner, at_turn));
  } else {
    append(m, lay_turn(loop, at_turn));
    append(m, pass_through(loop, t, at_turn));
  }
  m.push_back(draw_through(loop, t, kSlant));
  m.push_back(let_go(kLeftHand));
  append(m, pull_tight(kSlant, 0.7));
  m.push_back(swing(kDown));
  append(m, pull_tight(kDown, 1.0));
  m.push_back(wait(0.3));
  m.push_back(ease());
  m.push_back(let_go(kRightHand));
  m.back().ends_throw = true;
  return m;
}

}  // namespace

namespace {

bool hangs_straight(const Look& look) {
  constexpr double kStraight = 0.98;
  const double all = look.thread.length_m();
  return (look.thread.at(all) - look.thread.at(0.0)).norm() > kStraight * all;
}

}  // namespace

std::optional<std::size_t> throws_seen(const Knot& knot, const Look& look) {
  const int seen = seen_determinant(look.thread.between(0.0, look.thread.length_m()), kSeenFrom);
  int tied = 1;
  for (std::size_t k = 0; k <= knot.throws.size(); ++k) {
    if (seen == tied) return k;
    if (k < knot.throws.size()) tied *= determinant_of(knot.throws[k]);
  }
  return std::nullopt;
}

Moves draw_straight() {
  Moves m{take(kRightHand, the_end())};
  append(m, pull_tight(kDown, 0.5));
  m.push_back(ease());
  m.push_back(let_go(kRightHand));
  m.push_back(hang_out());
  return unless(hangs_straight, std::move(m));
}

Moves plan(const Knot& knot, const Workplace& place, std::size_t first) {
  if (knot.throws.empty()) return untie();
  const bool alone = knot.throws.size() == 1;
  std::vector<Throw> to_tie;
  int tied = 1;
  for (Throw t : knot.throws) {
    t.tied_already = tied;
    tied *= determinant_of(t);
    to_tie.push_back(t);
  }
  to_tie.erase(to_tie.begin(), to_tie.begin() + static_cast<std::ptrdiff_t>(first));
  Moves m;
  if (!is_springy(place) && !knot.throws.front().against) {
    m = throws_in_a_row(to_tie);
  } else {
    for (const Throw& t : to_tie) {
      if (t.tied_already > 1) m.push_back(wait(1.0));
      append(m, held_throw(t, place, alone));
    }
  }
  m.push_back(wait(kWatch_s));
  return m;
}

}  // namespace ligature::sim
