#include "sim_device/operator/primitives.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>

#include "sim_device/operator/diagram.hpp"

namespace ligature::sim {
namespace {

constexpr double kMoment_s = 0.15;  // what fingers need to close or open
const Vec3 kFront = -Vec3::UnitY();

/// Is the thread's place `s` between the jaws?
bool is_between_jaws(const Look& look, std::size_t hand, double s, double waited_s) {
  const double off_m = (look.sight.tool_W[hand] - look.thread.at(s)).norm();
  return off_m < (waited_s < 0.5 ? 0.4 : 1.5) * look.place.diameter_m;
}

/// The part of a that is across the unit vector `along`, as a unit vector.
Vec3 across(const Vec3& a, const Vec3& along) {
  const Vec3 rest = a - a.dot(along) * along;
  return rest.norm() > 1e-6 ? Vec3(rest.normalized()) : Vec3(along.unitOrthogonal());
}

}  // namespace

Move reach(std::size_t hand, WhereAlong s) {
  auto near_s = std::make_shared<double>(-1.0);  // when it was before the thread
  return {"reach", [=](const Look& look) {
            MovingHand& h = look.hands[hand];
            const double at = s(look);
            const Vec3 place = look.thread.at(at), before = place + look.place.clearance_m * kFront;
            const bool near = *near_s >= 0.0;
            h.pace = near ? 0.5 : 1.0;
            h.goal_W = near ? place : before;
            if (near) return is_between_jaws(look, hand, at, look.in_move_s - *near_s);
            if (look.has_arrived(hand, 0.3 * look.place.clearance_m)) *near_s = look.in_move_s;
            return false;
          }};
}

Move pinch(std::size_t hand) {
  return {"pinch", [=](const Look& look) {
            MovingHand& h = look.hands[hand];
            h.grip = true;
            h.goal_W = h.p_W();
            return look.in_move_s > kMoment_s;
          }};
}

Move let_go(std::size_t hand) {
  return {"let go", [=](const Look& look) {
            MovingHand& h = look.hands[hand];
            h.grip = false;
            if (look.in_move_s < kMoment_s) return false;
            h.pace = 0.5;
            h.goal_W = h.p_W() + 1.5 * look.place.clearance_m * kFront;  // out of the thread's way
            return look.in_move_s > 2.0 * kMoment_s;
          }};
}

Move carry(std::size_t hand, std::string name, Where where, double near, double pace) {
  return {std::move(name), [=](const Look& look) {
            look.hands[hand].pace = pace;
            look.hands[hand].goal_W = where(look);
            return look.has_arrived(hand, near * look.place.clearance_m);
          }};
}

/// As carry, but to where the place was when the move began: a ring that the hand drags along cannot be chased.
Move carry_straight(std::size_t hand, std::string name, Where where, double near) {
  auto goal = std::make_shared<std::optional<Vec3>>();
  return {std::move(name), [=](const Look& look) {
            if (!*goal) *goal = where(look);
            look.hands[hand].pace = 1.0;
            look.hands[hand].goal_W = **goal;
            if (!look.has_arrived(hand, near * look.place.clearance_m)) return false;
            goal->reset();
            return true;
          }};
}

Move wait(double seconds) {
  return {"wait", [=](const Look& look) { return look.in_move_s >= seconds; }, seconds + 1.0};
}

Move hang_out() {
  constexpr double kStill_s = 0.5;
  struct Seen {
    double since_s = 0.0;
    Vec3 end_W = Vec3::Zero();
  };
  auto seen = std::make_shared<Seen>();
  return {"hang out", [=](const Look& look) {
            const Vec3 end = look.thread.at(look.thread.length_m());
            const bool moved = (end - seen->end_W).norm() > 0.01 * look.place.length_m;
            if (moved || look.in_move_s == 0.0) *seen = {look.in_move_s, end};
            return look.in_move_s - seen->since_s > kStill_s;
          }};
}

Moves hand_over(std::size_t from, std::size_t to) {
  const auto beside = [from](const Look& look) {
    const double held = look.thread.nearest(look.sight.tool_W[from]);
    const double step = 0.3 * look.place.clearance_m + 2.0 * look.place.diameter_m;
    return held > step ? held - step : held + step;
  };
  return {reach(to, beside), pinch(to), let_go(from)};
}

Vec3 Loop::off(const Look& look, const Vec3& p_W) const {
  const Vec3 to = p_W - look.thread.at(look.thread.nearest(p_W, 0.0, corner_s_));
  return to - to.dot(along_) * along_;
}

Vec3 Loop::towards(double angle) const { return std::cos(angle) * front_ + std::sin(angle) * up_; }

double Loop::angle_of(const Look& look, const Vec3& p_W) const {
  const Vec3 to = off(look, p_W);
  return std::atan2(to.dot(up_), to.dot(front_));
}

/// Angle gone through from one place of the working part to another; in steps that are short beside the distance.
double Loop::wind(const Look& look, double from, double to) const {
  double sum = 0.0, before = angle_of(look, look.thread.at(from));
  const double finest = 0.1 * look.place.diameter_m;
  for (double w = from; w < to;) {
    w = std::min(to, w + std::clamp(0.3 * off(look, look.thread.at(w)).norm(), finest, 0.01 * look.place.length_m));
    const double now = angle_of(look, look.thread.at(w));
    sum += std::remainder(now - before, 2.0 * kPi);
    before = now;
  }
  return sum;
}

void Loop::look(const Look& look) {
  corner_s_ = corner_(look);
  along_ = (look.thread.at(corner_s_) - look.place.anchor_W).normalized();
  up_ = across(Vec3::UnitZ(), along_);
  front_ = static_cast<double>(side_) * across(kFront, along_);
  const double end = look.thread.length_m(), step = 0.004 * look.place.length_m, reach = 0.1 * look.place.length_m;
  const auto apart = [&](double w) { return off(look, look.thread.at(w)).norm(); };
  double most = -1.0, least = 1e9;
  const double first = std::max(corner_s_, far_ < 0.0 ? 0.0 : far_ - reach);
  const double last = far_ < 0.0 ? corner_s_ + 0.6 * (end - corner_s_) : std::min(far_ + reach, end);
  for (double w = first; w < last; w += step)
    if (const double r = apart(w); r > most) most = r, far_ = w;
  // X is where it first comes to the standing part: a turn further on may lie as near.
  for (double w = far_; w < end - 0.7 * look.place.clearance_m; w += step) {
    const double r = apart(w);
    if (least < look.place.diameter_m * 2.0 && r > 4.0 * look.place.diameter_m) break;
    if (r < least) least = r, working_ = w;
  }
  standing_ = look.thread.nearest(look.thread.at(working_), 0.0, corner_s_);
  const Ring ring(look.thread.between(standing_, working_));
  centre_W_ = ring.centre();
  crossing_W_ = look.thread.at(working_);
  angle_ = angle_of(look, centre_W_);
  wound_ = std::remainder(angle_of(look, look.thread.at(far_)) - angle_, 2.0 * kPi) + wind(look, far_, end);
  normal_W_ = ring.normal().dot(way()) < 0.0 ? Vec3(-ring.normal()) : ring.normal();
}

namespace {

constexpr double kTurn = 2.0 * 3.14159265358979323846;

/// Where the end goes round the standing part and how far.
struct Orbit {
  double wound;        ///< until the end is wound by this
  double slack = 0.0;  ///< from the top on: so many clearances further out ..
  double back = 0.0;   ///< .. and this share of the thread nearer to the anchor, so that the end trails loosely
};

/// Just short of the loop on the side from which the end goes through it: behind; or once more round and in front.
Orbit orbit_of(const Throw& t) { return t.against ? Orbit{1.07 * kTurn, 0.9, 0.048} : Orbit{0.88 * kTurn}; }

Move orbit(std::shared_ptr<Loop> loop, WhereAlong s, const Orbit& o) {
  return {"round the standing part", [=](const Look& look) {
            loop->look(look);
            const double left = o.wound - loop->wound();
            const double over = std::clamp((loop->wound() / kTurn - 0.455) / 0.2, 0.0, 1.0);
            MovingHand& h = look.hands[kRightHand];
            const double angle = loop->angle_of(look, look.sight.tool_W[kRightHand]) + std::clamp(left, -0.9, 0.9);
            h.pace = 0.7;
            h.goal_W = look.thread.at(s(look)) +
                       (1.4 + over * o.slack) * look.place.clearance_m * loop->towards(angle) -
                       over * o.back * look.place.length_m * loop->along();
            return std::abs(left) < 0.25;
          }};
}

/// `way` clearances from the loop's centre in the sense of the turn.
Where beside_centre(std::shared_ptr<Loop> loop, double way) {
  return [=](const Look& look) -> Vec3 {
    loop->look(look);
    return loop->centre() + way * look.place.clearance_m * loop->way();
  };
}

/// A place on the line from X through the loop's centre, `way` clearances off the loop's plane against the turn.
Where across_loop(std::shared_ptr<Loop> loop, double share, double way) {
  return [=](const Look& look) -> Vec3 {
    loop->look(look);
    return loop->crossing() + share * (loop->centre() - loop->crossing()) -
           way * look.place.clearance_m * loop->normal();
  };
}

}  // namespace

int determinant_of(const Throw& t) { return t.against ? 5 : 2 * t.passes + 1; }

bool would_hold(const Look& look, const Throw& t, const Vec3& out) {
  auto thread = look.thread.between(0.0, look.thread.length_m());
  const Vec3 back = look.place.anchor_W - look.sight.tool_W[kLeftHand];
  const Vec3 led = Vec3(back.x(), back.y(), 0.0).normalized() + Vec3::UnitZ();  // past the loop that hangs beside it
  thread.insert(thread.begin(), look.place.anchor_W + look.place.length_m * led);
  return seen_determinant(thread, out) == t.tied_already * determinant_of(t);
}

Moves lay_turn(std::shared_ptr<Loop> loop, const Throw& t, WhereAlong s) {
  const auto below = [=](const Look& look) -> Vec3 {
    loop->look(look);
    return look.thread.at(s(look)) + look.place.clearance_m * (1.4 * loop->towards(0.0) - 2.0 * Vec3::UnitZ());
  };
  return {carry(kRightHand, "to the turn", below, 0.7), orbit(loop, s, orbit_of(t))};
}

namespace {

/// The moves by which the end goes through the loop; in the sense of the turn, or against it.
Moves step_through(std::shared_ptr<Loop> loop, const Throw& t) {
  if (t.against) {  // the end drags the loop along; where it is passed moves on until the end is in front of it
    return {carry(kRightHand, "before the loop", across_loop(loop, 1.17, -1.2), 0.5),
            carry_straight(kRightHand, "through", across_loop(loop, 1.17, 3.1), 0.5)};
  }
  return {carry_straight(kRightHand, "before the loop", beside_centre(loop, -1.2), 0.5),
          carry_straight(kRightHand, "through", beside_centre(loop, 2.0), 0.5)};
}

}  // namespace

Moves pass_through(std::shared_ptr<Loop> loop, const Throw& t, WhereAlong s) {
  Moves steps = step_through(loop, t);
  steps.push_back(orbit(loop, s, orbit_of(t)));
  const auto is_through = [=](const Look& look) {
    loop->look(look);
    return would_hold(look, t, t.against ? Vec3(-loop->way()) : loop->way());
  };
  auto going = std::make_shared<std::size_t>(0);
  return {{"pass the end",
           [=](const Look& look) {
             if (!steps[*going].act(look)) return false;
             if (*going == 1 && is_through(look)) return true;
             *going = (*going + 1) % steps.size();
             return false;
           },
           t.against ? 10.0 : 30.0, is_through}};
}

Move draw_through(std::shared_ptr<Loop> loop, const Throw& t, Vec3 direction) {
  const Vec3 way = direction.normalized(), side = static_cast<double>(t.against ? -t.side : t.side) * kFront;
  return {"draw through",
          [=](const Look& look) {
            MovingHand& h = look.hands[kRightHand];
            loop->look(look);
            const Vec3 corner = look.sight.tool_W[kLeftHand];
            h.pace = 0.7;
            const double out = std::max(0.0, way.dot(h.p_W() - corner)), step = 0.1 * look.place.length_m;
            h.goal_W = corner + (out + step) * way + look.place.clearance_m * side;
            const double pull_N = -way.dot(look.sight.force_W_N[kRightHand]);
            if (out < step && look.in_move_s < 8.0) return false;  // past the corner first, whatever it catches on
            if (loop->around_m() > 20.0 * look.place.diameter_m && pull_N < 0.5 * look.place.tension_N) return false;
            h.goal_W = h.p_W();
            return true;
          },
          15.0, [=](const Look& look) { return would_hold(look, t, side); }};
}

Moves pull_tight(Vec3 direction, double share) {
  const Vec3 way = direction.normalized();
  return {{"pull tight",
           [=](const Look& look) {
             MovingHand& h = look.hands[kRightHand];
             const double pull_N = -way.dot(look.sight.force_W_N[kRightHand]) / (share * look.place.tension_N);
             h.pace = pull_N > 0.3 ? 0.1 : 0.5;
             const Vec3 off = h.p_W() - look.place.anchor_W;
             const double out = way.dot(off) + 0.15 * look.place.length_m;
             h.goal_W = look.place.anchor_W + out * way;
             if (pull_N < 1.0 && way.dot(off) < 1.1 * look.place.length_m) return false;
             h.goal_W = h.p_W();
             return true;
           },
           30.0}};
}

Move swing(Vec3 direction) {
  const Vec3 way = direction.normalized();
  return {"swing", [=](const Look& look) {
            MovingHand& h = look.hands[kRightHand];
            const Vec3 off = h.p_W() - look.place.anchor_W;
            const Vec3 turned = (off.normalized() + 0.3 * (way - off.normalized())).normalized();
            h.pace = 0.6;
            const bool near = (off.normalized() - way).norm() < 0.05;
            h.goal_W = look.place.anchor_W + off.norm() * (near ? way : turned);
            return near && h.to_go_m() < 0.5 * look.place.clearance_m;
          }};
}

Move ease() {
  return {"ease", [](const Look& look) {
            MovingHand& h = look.hands[kRightHand];
            const Vec3 to = (look.place.anchor_W - h.p_W()).normalized();
            h.pace = 0.15;
            h.goal_W = h.p_W() + 0.05 * look.place.length_m * to;
            if (to.dot(look.sight.force_W_N[kRightHand]) > 0.03 * look.place.tension_N) return false;
            h.goal_W = h.p_W();
            return true;
          }};
}

}  // namespace ligature::sim
