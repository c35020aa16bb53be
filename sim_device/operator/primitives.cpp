#include "sim_device/operator/primitives.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

namespace ligature::sim {
namespace {

constexpr double kMoment_s = 0.15;  // what fingers need to close or open
const Vec3 kFront = -Vec3::UnitY();

/// Is the thread's place `s` between the jaws?
bool is_between_jaws(const Look& look, std::size_t hand, double s, double waited_s) {
  const double off_m = (look.sight.tool_W[hand] - look.thread.at(s)).norm();
  return off_m < (waited_s < 0.5 ? 0.4 : 1.5) * look.place.diameter_m;
}
}  // namespace

Move reach(std::size_t hand, const WhereAlong& s) {
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

Move carry(std::size_t hand, std::string name, const Where& where, double near, double pace) {
  return {std::move(name), [=](const Look& look) {
            look.hands[hand].pace = pace;
            look.hands[hand].goal_W = where(look);
            return look.has_arrived(hand, near * look.place.clearance_m);
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

Moves pull_tight(const Vec3& direction, double share) {
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

Move swing(const Vec3& direction) {
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
