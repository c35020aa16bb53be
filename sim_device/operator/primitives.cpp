#include "sim_device/operator/primitives.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <optional>

namespace ligature::sim {
namespace {

constexpr double kMoment_s = 0.15;  // time that fingers need to close or open
const Vec3 kFront = -Vec3::UnitY();

/// Whether place `s` of the thread is between the jaws; the tolerance grows after 0.5 s.
bool is_between_jaws(const Look& look, std::size_t hand, double s, double waited_s) {
  const double off_m = (look.sight.tool_W[hand] - look.thread.at(s)).norm();
  return off_m < (waited_s < 0.5 ? 0.4 : 1.5) * look.place.diameter_m;
}
}  // namespace

Move take(std::size_t hand, const WhereAlong& s) {
  constexpr double kLong_s = 3.0, kSlide_per_s = 0.04,
                   kMost = 0.06;  // the last two are fractions of the thread's length
  enum Phase { kBefore, kNear, kClosed };
  struct State {
    Phase phase = kBefore;
    double since_s = 0.0;
  };
  auto state = std::make_shared<State>();
  return {"take",
          [=](const Look& look) {
            MovingHand& h = look.hands[hand];
            const double now_s = look.in_move_s, in_phase_s = now_s - state->since_s;
            const bool near = state->phase == kNear;
            const double late_s = near ? std::max(0.0, in_phase_s - kLong_s) : 0.0;
            const double at = s(look) - std::min(kSlide_per_s * late_s, kMost) * look.thread.length_m();
            const Vec3 place = look.thread.at(at);
            const auto go_on = [&](Phase phase) {
              *state = {phase, now_s};
              h.grip = phase == kClosed;
              return false;
            };
            if (state->phase == kClosed) {
              h.goal_W = h.p_W();
              if (in_phase_s <= kMoment_s) return false;
              return look.sight.holds[hand] || go_on(kBefore);
            }
            h.pace = near ? 0.5 : 1.0;
            h.goal_W = near ? place : Vec3(place + look.place.clearance_m * kFront);
            if (near) return is_between_jaws(look, hand, at, in_phase_s) && go_on(kClosed);
            return look.has_arrived(hand, 0.3 * look.place.clearance_m) && go_on(kNear);
          },
          15.0, [=](const Look& look) { return look.hands[hand].grip && look.sight.holds[hand]; }};
}

Move let_go(std::size_t hand) {
  return {"let go", [=](const Look& look) {
            MovingHand& h = look.hands[hand];
            h.grip = false;
            if (look.in_move_s < kMoment_s) return false;
            h.pace = 0.5;
            h.goal_W = h.p_W() + 1.5 * look.place.clearance_m * kFront;  // moves out of the thread's way
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

Moves unless(const std::function<bool(const Look&)>& needless, Moves moves) {
  auto skip = std::make_shared<std::optional<bool>>();
  for (Move& m : moves) {
    m.act = [=, act = std::move(m.act)](const Look& look) {
      if (!*skip) *skip = needless(look);
      return **skip || act(look);
    };
    if (m.good) m.good = [=, good = std::move(m.good)](const Look& look) { return **skip || good(look); };
  }
  return moves;
}

}  // namespace ligature::sim
