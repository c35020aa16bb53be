#include "sim_device/operator/springy_throw.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <span>

#include "sim_device/operator/diagram.hpp"
#include "sim_device/operator/primitives.hpp"

namespace ligature::sim {
namespace {

constexpr double kSpringy = 0.2;
constexpr double kNear = 0.045, kArrived = 0.02, kPast = 0.025;  // distances, as fractions of the working part's length

/// A way point of the thread's end: its offset from the corner, or from the place on the standing part where the end
/// crosses over. The components, in fractions of the working part's length, point to the front, up, and out (away from
/// the anchor).
struct Stop {
  bool from_corner;
  double front, up, out;
};

constexpr Stop kOnce[] = {
    {true, 0.12, -0.18, 0.0},                                     // far to the front, so that the arch opens there
    {false, 0.09, 0.018, 0.0},                                    // up, in front of the standing part
    {false, 0.045, 0.042, 0.0},                                   // higher than the standing part, still in front
    {false, 0.0, 0.042, 0.0},                                     // straight above the standing part
    {false, -0.03, -0.012, 0.0},                                  // down behind it
    {true, -0.024, -0.042, -0.06}, {true, 0.006, -0.042, -0.03},  // forward, under the standing part
    {true, 0.06, -0.03, 0.09},                                    // through the loop
};

/// Two rounds of kOnce, the first one nearer to the anchor. Between them the end goes back to the front of the corner:
/// there the arch stands beyond the corner again, as at the start of the first round.
constexpr Stop kTwice[] = {
    {true, 0.12, -0.18, 0.0},                                     // far to the front, so that the arch opens there
    {false, 0.09, 0.018, -0.04},                                  // up, in front of the standing part
    {false, 0.045, 0.042, -0.04},                                 // higher than the standing part, still in front
    {false, 0.0, 0.042, -0.04},                                   // straight above the standing part
    {false, -0.03, -0.012, -0.04},                                // down behind it
    {true, -0.03, -0.08, -0.12},   {true, 0.02, -0.08, -0.1},     // forward under it, through the loop
    {true, 0.12, -0.1, 0.0},                                      // to the front of the corner
    {false, 0.09, 0.018, 0.03},                                   // second round: up, in front of the standing part
    {false, 0.045, 0.042, 0.03},                                  // second round: higher, still in front
    {false, 0.0, 0.042, 0.03},                                    // second round: straight above the standing part
    {false, -0.03, -0.012, 0.03},                                 // second round: down behind it
    {true, -0.024, -0.042, -0.06}, {true, 0.006, -0.042, -0.03},  // forward, under the standing part
    {true, 0.06, -0.03, 0.09},                                    // through the loop
};

constexpr Stop kAgainst[] = {
    {true, 0.12, -0.18, 0.0},                                // far to the front, so that the arch opens there
    {false, 0.09, 0.018, 0.0},                               // up, in front of the standing part
    {false, 0.045, 0.042, 0.0},                              // higher than the standing part, still in front
    {false, 0.0, 0.042, 0.0},                                // straight above the standing part
    {false, -0.06, -0.012, 0.0},                             // down behind it
    {true, -0.15, -0.15, -0.2},                              // further behind and down, towards the anchor
    {true, -0.12, -0.42, -0.2},  {true, 0.15, -0.42, -0.2},  // forward below the whole arch, not through it
    {true, 0.2, -0.1, -0.15},    {true, 0.08, -0.05, -0.1},  // up in front of the arch
    {true, -0.06, -0.1, -0.08},  {true, -0.1, -0.03, 0.09},  // through the loop, to the back
};

std::span<const Stop> path_of(const Throw& t) {
  if (t.against) return kAgainst;
  if (t.passes > 1) return kTwice;
  return kOnce;
}

/// Whether the thread would hold this throw if its ends were led away to the front, and also outwards past the corner.
bool is_tied(const Look& look, const Throw& t, const Vec3& front, const Vec3& out) {
  const auto thread = look.thread.between(0.0, look.thread.length_m());
  const int tied = determinant_of(t) * t.tied_already;
  return seen_determinant(thread, front) == tied && seen_determinant(thread, 0.8 * front + 0.6 * out) == tied;
}

}  // namespace

bool is_springy(const Workplace& place) { return place.bend_length_m > kSpringy * place.length_m; }

Move open_arch(const Throw& t, const WhereAlong& corner) {
  constexpr double kLow = -0.62, kHigh = -0.18, kOut = 0.12;  // fractions of the working part's length
  constexpr double kQuarter = 0.5 * std::numbers::pi;
  enum Phase { kRaise, kAside, kToFront };
  struct State {
    Phase phase = kRaise;
    double angle = 0.0;
  };
  const Vec3 front = -static_cast<double>(t.side) * Vec3::UnitY();
  auto state = std::make_shared<State>();
  return {"open the arch",
          [=](const Look& look) {
            const double all = look.thread.length_m(), at = corner(look), unit = all - at;
            const Vec3 from = look.thread.at(at);
            Vec3 out = look.sight.tool_W[kLeftHand] - look.place.anchor_W;
            out = (out - out.z() * Vec3::UnitZ()).normalized();
            const auto angle_of = [&](const Vec3& p) { return std::atan2(front.dot(p - from), out.dot(p - from)); };
            Vec3 middle = Vec3::Zero();
            const auto arch = look.thread.between(at, all);
            for (const Vec3& p : arch) middle += p / static_cast<double>(arch.size());
            MovingHand& h = look.hands[kRightHand];
            const Vec3 tool = look.sight.tool_W[kRightHand];
            const double left = std::remainder(kQuarter - angle_of(tool), 4.0 * kQuarter);
            const double angle = state->phase == kToFront ? angle_of(tool) + std::clamp(left, -0.6, 0.6) : state->angle;
            const Vec3 aside = kOut * (std::cos(angle) * out + std::sin(angle) * front) + kHigh * Vec3::UnitZ();
            h.pace = state->phase == kToFront ? 0.4 : 1.0;
            h.goal_W = from + unit * (state->phase == kRaise ? Vec3(kLow * Vec3::UnitZ()) : aside);
            if ((tool - h.goal_W).norm() > kNear * unit) return false;
            if (state->phase == kRaise)
              *state = {kAside, angle_of(middle) + kQuarter};
            else if (state->phase == kAside)
              state->phase = kToFront;
            else {
              state->phase = kRaise;
              return std::cos(angle_of(middle)) > 0.0;
            }
            return false;
          },
          15.0};
}

Move springy_throw(const Throw& t, const WhereAlong& corner, const WhereAlong& turn) {
  const Vec3 front = -static_cast<double>(t.side) * Vec3::UnitY();
  const auto out = [](const Look& look) -> Vec3 {
    return (look.sight.tool_W[kLeftHand] - look.place.anchor_W).normalized();
  };
  const auto unit = [=](const Look& look) { return look.thread.length_m() - corner(look); };
  const auto place = [=](const Look& look, const Stop& stop) -> Vec3 {
    const Vec3 from = look.thread.at(stop.from_corner ? corner(look) : turn(look));
    return from + unit(look) * (stop.front * front + stop.up * Vec3::UnitZ() + stop.out * out(look));
  };
  const auto is_through = [=](const Look& look) {
    const double gone =
        (t.against ? -1.0 : 1.0) * front.dot(look.sight.tool_W[kRightHand] - look.thread.at(corner(look)));
    return gone > kPast * unit(look) && is_tied(look, t, front, out(look));
  };
  const auto path = path_of(t);
  auto next = std::make_shared<std::size_t>(0);
  return {"over and through",
          [=](const Look& look) {
            MovingHand& h = look.hands[kRightHand];
            h.pace = 1.0;
            h.goal_W = place(look, path[*next]);
            const bool last = *next + 1 == path.size();
            const double off = (look.sight.tool_W[kRightHand] - h.goal_W).norm() / unit(look);
            if (!(last && is_through(look)) && off > (last ? kArrived : kNear)) return false;
            *next = last ? 0 : *next + 1;
            return last;
          },
          15.0, is_through};
}

}  // namespace ligature::sim
