#include "sim_device/operator/figure_eight.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "sim_device/operator/primitives.hpp"

namespace ligature::sim {
namespace {

/// As carry(), but the goal is fixed when the move begins: the hand drags the loop along, so a goal on the loop would
/// keep moving away.
Move carry_straight(std::size_t hand, std::string name, const Where& where, double near) {
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

constexpr double kTurn = 2.0 * 3.14159265358979323846;

constexpr double kWound = 1.07 * kTurn;  // angle of the end's turn about the standing part, until in front again
constexpr double kSlack = 0.9;           // extra distance from the standing part after the turn's top, in clearances
// Shift of the hand towards the anchor after the turn's top, as a fraction of the thread's length; it keeps the end
// slack.
constexpr double kBack = 0.048;

Move orbit(const std::shared_ptr<Loop>& loop, const WhereAlong& s) {
  return {"round the standing part", [=](const Look& look) {
            loop->look(look);
            const double left = kWound - loop->wound();
            const double over = std::clamp((loop->wound() / kTurn - 0.455) / 0.2, 0.0, 1.0);
            MovingHand& h = look.hands[kRightHand];
            const double angle = loop->angle_of(look, look.sight.tool_W[kRightHand]) + std::clamp(left, -0.9, 0.9);
            h.pace = 0.7;
            h.goal_W = look.thread.at(s(look)) + (1.4 + over * kSlack) * look.place.clearance_m * loop->towards(angle) -
                       over * kBack * look.place.length_m * loop->along();
            return std::abs(left) < 0.25;
          }};
}

/// A point near the loop: `share` of the way from the crossing X to the loop's centre (above 1: beyond the centre), and
/// out of the loop's plane by `way` times Workplace::clearance_m, against the direction in which the turn passes
/// through the loop.
Where across_loop(const std::shared_ptr<Loop>& loop, double share, double way) {
  return [=](const Look& look) -> Vec3 {
    loop->look(look);
    return loop->crossing() + share * (loop->centre() - loop->crossing()) -
           way * look.place.clearance_m * loop->normal();
  };
}

}  // namespace

Moves lay_turn(const std::shared_ptr<Loop>& loop, const WhereAlong& s) {
  const auto below = [=](const Look& look) -> Vec3 {
    loop->look(look);
    return look.thread.at(s(look)) + look.place.clearance_m * (1.4 * loop->towards(0.0) - 2.0 * Vec3::UnitZ());
  };
  return {carry(kRightHand, "to the turn", below, 0.7), orbit(loop, s)};
}

Moves pass_through(const std::shared_ptr<Loop>& loop, const Throw& t, const WhereAlong& s) {
  // The end drags the loop along, so the steps repeat until the end has passed through.
  Moves steps{carry(kRightHand, "before the loop", across_loop(loop, 1.17, -1.2), 0.5),
              carry_straight(kRightHand, "through", across_loop(loop, 1.17, 3.1), 0.5), orbit(loop, s)};
  const auto is_through = [=](const Look& look) {
    loop->look(look);
    return would_hold(look, t, -loop->way());
  };
  auto going = std::make_shared<std::size_t>(0);
  return {{"pass the end",
           [=](const Look& look) {
             if (!steps[*going].act(look)) return false;
             if (*going == 1 && is_through(look)) return true;
             *going = (*going + 1) % steps.size();
             return false;
           },
           10.0, is_through}};
}

Move draw_through(const std::shared_ptr<Loop>& loop, const Throw& t, const Vec3& direction) {
  const Vec3 way = direction.normalized(), side = static_cast<double>(t.against ? t.side : -t.side) * Vec3::UnitY();
  return {"draw through",
          [=](const Look& look) {
            MovingHand& h = look.hands[kRightHand];
            loop->look(look);
            const Vec3 corner = look.sight.tool_W[kLeftHand];
            h.pace = 0.7;
            const double out = std::max(0.0, way.dot(h.p_W() - corner)), step = 0.1 * look.place.length_m;
            h.goal_W = corner + (out + step) * way + look.place.clearance_m * side;
            const double pull_N = -way.dot(look.sight.force_W_N[kRightHand]);
            // The end must first be past the corner, even if it catches on something
            if (out < step && look.in_move_s < 8.0) return false;
            if (loop->around_m() > 20.0 * look.place.diameter_m && pull_N < 0.5 * look.place.tension_N) return false;
            h.goal_W = h.p_W();
            return true;
          },
          15.0, [=](const Look& look) { return would_hold(look, t, side); }};
}

}  // namespace ligature::sim
