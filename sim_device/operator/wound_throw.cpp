#include "sim_device/operator/wound_throw.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "sim_device/operator/primitives.hpp"

namespace ligature::sim {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kRadius = 1.1;                        // radius of the helix, in clearances
constexpr double kFirst = 0.3, kLast = 0.8;            // start and end of the helix, as fractions of the standing part
const Vec3 kOut = Vec3(0.85, 0.0, 0.52).normalized();  // direction of the standing part: to the right and up
// Direction in which the end is drawn: past the corner and down
const Vec3 kAway = Vec3(0.89, 0.0, -0.45).normalized();
// Almost straight down: the thread's own hanging end may be out of reach
const Vec3 kHang = Vec3(0.3, 0.0, -1.0).normalized();

/// Pull that draws a throw tight, as a multiple of Workplace::tension_N. Larger for short thick threads, because length
/// that stays in a loose knot is missing for the next throw.
double firm(const Workplace& place) { return std::clamp(200.0 * place.diameter_m / place.length_m, 1.0, 4.0); }

/// Direction of the side on which the end starts and comes out again: +y or -y.
Vec3 front_of(const Throw& t) { return static_cast<double>(t.side) * Vec3::UnitY(); }

/// Coordinates of a point near the standing part: its position along the standing part, as a fraction of the part's
/// length, and its direction from there, as an angle (0 in front, a quarter turn above).
class Standing {
 public:
  Standing(const Look& look, const Site& site, const Throw& t) : look_(look), site_(site) {
    from_ = look.thread.at(site.base);
    const Vec3 to = look.thread.at(site.corner) - from_;
    const Vec3 level(to.x(), to.y(), 0.0);
    length_m_ = std::max(level.norm(), 1e-9);
    along_ = level / length_m_;
    front_ = across(front_of(t));
    up_ = Vec3::UnitZ();
  }

  [[nodiscard]] Vec3 beside(double share, double radius_m, double angle) const {
    return at(share) + radius_m * (std::cos(angle) * front_ + std::sin(angle) * up_);
  }
  /// Angle of a point about the standing part, at the position along it that is level with the point.
  [[nodiscard]] double angle_of(const Vec3& p_W) const {
    const Vec3 off = p_W - at(std::clamp((p_W - from_).dot(along_) / length_m_, 0.05, 0.95));
    return std::atan2(off.dot(up_), off.dot(front_));
  }

 private:
  [[nodiscard]] Vec3 at(double share) const {
    return look_.thread.at(site_.base + share * (site_.corner - site_.base));
  }
  [[nodiscard]] Vec3 across(const Vec3& a) const { return (a - a.dot(along_) * along_).normalized(); }

  const Look& look_;
  const Site& site_;
  Vec3 from_, along_, front_, up_;
  double length_m_ = 0.0;
};

/// The left hand moves the corner outwards on an arc about the anchor. On a straight line the slack corner could pass
/// through open loops of the existing knot.
Move swing_out() {
  auto reach_m = std::make_shared<double>(-1.0);
  return {"swing the corner out",
          [=](const Look& look) {
            MovingHand& h = look.hands[kLeftHand];
            const Vec3 off = h.p_W() - look.place.anchor_W;
            if (*reach_m < 0.0) *reach_m = off.norm();
            constexpr double kStep = 0.4;
            const Vec3 way = off.normalized(), rest = kOut - kOut.dot(way) * way;
            const double left = std::atan2(rest.norm(), kOut.dot(way));
            const Vec3 next = left < kStep ? kOut : Vec3(std::cos(kStep) * way + std::sin(kStep) * rest.normalized());
            h.pace = 0.8;
            h.goal_W = look.place.anchor_W + *reach_m * next;
            return left < 0.05 && h.to_go_m() < 0.3 * look.place.clearance_m;
          },
          25.0};
}

/// Whether the throw would hold if the end were drawn past the corner now.
bool is_laid(const Look& look, const Throw& t) {
  return would_hold(look, t, front_of(t)) && would_hold(look, t, 0.8 * front_of(t) + 0.6 * kAway);
}

/// The end goes `t.passes` times round the standing part. From the top of the first turn on, the end also moves along
/// the standing part. The last turn goes slightly further if the end has not yet passed the swinging bight.
Move wind(const Throw& t, const std::shared_ptr<const Site>& site) {
  auto wound = std::make_shared<std::optional<double>>();
  constexpr double kFurther = 0.6;
  const double last = 2.0 * kPi * t.passes;
  return {"wind",
          [=](const Look& look) {
            const Standing standing(look, *site, t);
            MovingHand& h = look.hands[kRightHand];
            const double now = standing.angle_of(look.sight.tool_W[kRightHand]);
            *wound = *wound ? **wound + std::remainder(now - **wound, 2.0 * kPi) : now;
            const double goal = std::min(last + kFurther, **wound + 0.8);
            const double gone = std::clamp((goal - 0.5 * kPi) / (last - kPi), 0.0, 1.0);
            h.pace = 0.7;
            h.goal_W = standing.beside(kFirst + gone * (kLast - kFirst), kRadius * look.place.clearance_m, goal);
            if (**wound < last - 0.25) return false;
            return is_laid(look, t) || **wound > last + kFurther - 0.25;
          },
          15.0 * (1 + t.passes), [=](const Look& look) { return is_laid(look, t); }};
}

/// Whether the knot is as short as pulling can make it: 10 diameters plus 12 diameters per turn in a thread thicker
/// than 1/200 of its length, twice as much in a thinner one.
bool is_small(const Look& look, int turns) {
  const Tangle knotted = tangle(look);
  const double longest = (10.0 + 12.0 * turns) * look.place.diameter_m * (firm(look.place) > 1.0 ? 1.0 : 2.0);
  return knotted.last_m - knotted.first_m < longest;
}

/// The end is drawn past the corner, which the left hand still holds, until the throw is small.
Move draw(const Throw& t) {
  constexpr double kMost = 2.0;
  return {"draw", [=](const Look& look) {
            MovingHand& h = look.hands[kRightHand];
            const Vec3 corner = look.sight.tool_W[kLeftHand];
            const double out = std::max(0.0, kAway.dot(h.p_W() - corner)) + 0.1 * look.place.length_m;
            h.pace = 0.7;
            h.goal_W = corner + out * kAway + look.place.clearance_m * front_of(t);
            const double pull =
                -kAway.dot(look.sight.force_W_N[kRightHand]) / (firm(look.place) * look.place.tension_N);
            if (pull < 1.0 || (pull < kMost && !is_small(look, t.passes))) return false;
            h.goal_W = h.p_W();
            return true;
          }};
}

/// Moves away from the anchor until the knot is tight, then back until half of the pull is gone.
Moves pull_and_ease() {
  const auto pull_N = [](const Look& look, const Vec3& way) { return -way.dot(look.sight.force_W_N[kRightHand]); };
  Moves m;
  m.push_back({"pull tight",
               [=](const Look& look) {
                 MovingHand& h = look.hands[kRightHand];
                 const Vec3 off = h.p_W() - look.place.anchor_W, way = off.normalized();
                 const double share = pull_N(look, way) / look.place.tension_N;
                 h.pace = share > 0.3 ? 0.15 : 0.5;
                 h.goal_W = h.p_W() + 0.15 * look.place.length_m * way;
                 if (share < 1.0 && off.norm() < 1.1 * look.place.length_m) return false;
                 h.goal_W = h.p_W();
                 return true;
               },
               30.0});
  m.push_back({"ease",
               [=](const Look& look) {
                 MovingHand& h = look.hands[kRightHand];
                 const Vec3 way = (h.p_W() - look.place.anchor_W).normalized();
                 h.pace = 0.15;
                 h.goal_W = h.p_W() - 0.05 * look.place.length_m * way;
                 if (pull_N(look, way) > 0.5 * look.place.tension_N) return false;
                 h.goal_W = h.p_W();
                 return true;
               },
               5.0});
  return m;
}

}  // namespace

Tangle tangle(const Look& look) {
  const double step = look.place.diameter_m, all = look.thread.length_m();
  constexpr std::size_t kNeighbours = 3;
  constexpr double kTouch = 1.6;  // in diameters: in a coarse thread the strands at a knot stay further apart
  std::vector<Vec3> points;
  double s = 0.0;
  while (s < all) {
    points.push_back(look.thread.at(s));
    s += step;
  }
  Tangle t{all, 0.0};
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t j = i + kNeighbours; j < points.size(); ++j) {
      if ((points[i] - points[j]).norm() > kTouch * step) continue;
      t.first_m = std::min(t.first_m, step * static_cast<double>(i));
      t.last_m = std::max(t.last_m, step * static_cast<double>(j));
    }
  }
  return t;
}

Moves wound_throw(const Throw& t, const std::shared_ptr<const Site>& site) {
  const auto corner = [site](const Look&) { return site->corner; };
  const auto end = [](const Look& look) { return look.thread.length_m(); };
  const auto before = [site, t](const Look& look) {  // a point below and in front of the start of the helix
    return Standing(look, *site, t).beside(kFirst, 2.0 * look.place.clearance_m, -0.3 * kPi);
  };
  Moves m{take(kLeftHand, corner), swing_out(), take(kRightHand, end)};
  m.push_back(carry(kRightHand, "to the standing part", before, 0.7));
  m.push_back(wind(t, site));
  m.push_back(draw(t));
  m.push_back(let_go(kLeftHand));
  append(m, pull_and_ease());
  m.push_back(swing(kHang));  // released under tension, an undamped thread would whip its knot open
  m.push_back(let_go(kRightHand));
  return m;
}

Moves throws_in_a_row(std::span<const Throw> throws) {
  auto site = std::make_shared<Site>();
  Moves m;
  m.push_back(wait(2.0));  // until the thread hangs still
  for (const Throw& t : throws) {
    const double more = 1.0 + 0.25 * (t.passes - 1);
    m.push_back({"see the knot", [site, more](const Look& look) {
                   const double c = more * look.place.clearance_m, knotted = tangle(look).last_m;
                   *site = knotted > 0.0 ? Site{knotted, knotted + 2.6 * c} : Site{0.0, 3.6 * c};
                   return true;
                 }});
    append(m, wound_throw(t, site));
    m.push_back(wait(2.0));
    m.back().good = [t](const Look& look) { return would_hold(look, t, front_of(t)); };
    m.back().ends_throw = true;
  }
  return m;
}

}  // namespace ligature::sim
