#include "sim_device/operator/untie.hpp"

#include <algorithm>
#include <array>
#include <memory>

#include "sim_device/operator/diagram.hpp"
#include "sim_device/operator/primitives.hpp"

namespace ligature::sim {
namespace {

const Vec3 kEye = Vec3(0.0, -1.0, 1.0);  // from above and in front: sees a hanging thread, and one on a desk
// Where the hand takes the thread in each of three tries: distance from the end of the knot inwards, in diameters
constexpr std::array kInside_d{1.0, 3.0, 5.0};
constexpr double kDrawn = 0.36;  // how far the hand draws, as a fraction of the thread's length
// Pull at which the hand stops, because the knot has jammed; as a multiple of the pull at which a knot is tight
constexpr double kMostPull = 1.3;
// The operator looks for the knot's end at 100 places of the thread, then more closely.
constexpr double kLookAt = 0.01;

struct Pull {
  double at_m = 0.0;  ///< where the hand takes the thread, as an arc length
  /// Direction in which the hand draws: from the free end towards the end of the knot; never down, where a desk may be
  Vec3 way = Vec3::UnitX();
};

/// Determinant of the knot in the thread from its start to `last_m`.
int seen(const Look& look, double last_m) { return seen_determinant(look.thread.between(0.0, last_m), kEye); }

bool no_knot_seen(const Look& look) { return seen(look, look.thread.length_m()) == 1; }

/// Arc length at which the knot ends, to within one diameter: the thread beyond it could be cut off without changing
/// the knot. Two step lengths, because a search in single diameters takes long in a long thin thread.
double knot_end_m(const Look& look) {
  double end_m = look.thread.length_m();
  const int knotted = seen(look, end_m);
  for (const double step_m : {std::max(look.place.diameter_m, kLookAt * end_m), look.place.diameter_m})
    while (end_m > step_m && seen(look, end_m - step_m) == knotted) end_m -= step_m;
  return end_m;
}

Move see_the_knot(const std::shared_ptr<Pull>& pull, double inside_d) {
  return {"see the knot", [=](const Look& look) {
            const double end_m = knot_end_m(look);
            Vec3 back = look.thread.at(end_m) - look.thread.at(look.thread.length_m());
            back.z() = std::max(back.z(), 0.0);
            *pull = {end_m - inside_d * look.place.diameter_m, back.normalized()};
            return true;
          }};
}

/// The hand's goal: from where it took the thread, kDrawn of the thread's length along Pull::way, and one diameter up,
/// so that the drawn thread passes above the strands that it crosses. When the thread pulls too hard (kMostPull), the
/// goal is the place where the hand is.
Where drawn_back(const std::shared_ptr<const Pull>& pull) {
  auto from = std::make_shared<Vec3>();
  return [=](const Look& look) -> Vec3 {
    if (look.in_move_s == 0.0) *from = look.hands[kRightHand].p_W();
    const double held_N = -pull->way.dot(look.sight.force_W_N[kRightHand]);
    if (held_N > kMostPull * look.place.tension_N) return look.hands[kRightHand].p_W();
    return *from + kDrawn * look.place.length_m * pull->way + look.place.diameter_m * Vec3::UnitZ();
  };
}

}  // namespace

Moves untie() {
  Moves all;
  for (const double inside_d : kInside_d) {
    auto pull = std::make_shared<Pull>();
    all.push_back(hang_out());
    append(all, unless(no_knot_seen,
                       {see_the_knot(pull, inside_d), take(kRightHand, [pull](const Look&) { return pull->at_m; }),
                        carry(kRightHand, "draw back", drawn_back(pull)), wait(1.0), let_go(kRightHand)}));
  }
  all.push_back({"see that no knot is left", no_knot_seen, 2.0});
  return all;
}

}  // namespace ligature::sim
