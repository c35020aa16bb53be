#include "sim_device/operator/springy_throw.hpp"

#include "sim_device/operator/diagram.hpp"

namespace ligature::sim {
namespace {

constexpr double kSpringy = 0.2;
constexpr int kOverhand = 3;  // determinant

/// A place of the path, in shares of the working part from the corner or from the turn: to the front, up, out past the
/// corner.
struct Stop {
  bool from_corner;
  double front, up, out;
};

constexpr Stop kPath[] = {
    {true, 0.12, -0.18, 0.0},                                     // out in front, so that the arch opens there
    {false, 0.09, 0.018, 0.0},                                    // up
    {false, 0.045, 0.042, 0.0},                                   //
    {false, 0.0, 0.042, 0.0},                                     // over
    {false, -0.03, -0.012, 0.0},                                  // behind
    {true, -0.024, -0.042, -0.06}, {true, 0.006, -0.042, -0.03},  // forward, under the standing part
    {true, 0.06, -0.03, 0.09},                                    // and through
};
constexpr std::size_t kStops = std::size(kPath);

/// Would the thread hold one overhand more with its ends led away to the front, and out past the corner?
bool is_tied(const Look& look, const Throw& t, const Vec3& front, const Vec3& out) {
  const auto thread = look.thread.between(0.0, look.thread.length_m());
  const int tied = kOverhand * t.tied_already;
  return seen_determinant(thread, front) == tied && seen_determinant(thread, 0.8 * front + 0.6 * out) == tied;
}

}  // namespace

bool is_springy(const Workplace& place) { return place.bend_length_m > kSpringy * place.length_m; }

Move springy_throw(const Throw& t, WhereAlong corner, WhereAlong turn) {
  const Vec3 front = -static_cast<double>(t.side) * Vec3::UnitY();
  const auto out = [](const Look& look) -> Vec3 {
    return (look.sight.tool_W[kLeftHand] - look.place.anchor_W).normalized();
  };
  const auto place = [=](const Look& look, const Stop& stop) -> Vec3 {
    const double at = corner(look), unit = look.thread.length_m() - at;
    const Vec3 from = look.thread.at(stop.from_corner ? at : turn(look));
    return from + unit * (stop.front * front + stop.up * Vec3::UnitZ() + stop.out * out(look));
  };
  const auto is_through = [=](const Look& look) {
    const double gone = front.dot(look.sight.tool_W[kRightHand] - look.thread.at(corner(look)));
    return gone > 0.5 * look.place.clearance_m && is_tied(look, t, front, out(look));
  };
  auto next = std::make_shared<std::size_t>(0);
  return {"over and through",
          [=](const Look& look) {
            MovingHand& h = look.hands[kRightHand];
            h.pace = 1.0;
            h.goal_W = place(look, kPath[*next]);
            const bool last = *next + 1 == kStops;
            if (!(last && is_through(look)) && !look.has_arrived(kRightHand, 0.8 * look.place.clearance_m))
              return false;
            *next = last ? 0 : *next + 1;
            return last;
          },
          15.0, is_through};
}

}  // namespace ligature::sim
