#pragma once
// The panel of the ablation study: pulls of knots, and a ball of thread. They are other cases than those with which the
// rod's numbers (tuning.hpp) were chosen.

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "tests/bench/rod/pull.hpp"

namespace ligature::bench {

struct Case {
  std::string name, scene;
  std::vector<std::string> overrides;
  Pull pull;
  bool opens = false;  ///< theory says that this knot comes undone
};

/// Cases with speeds drawn from 0.05 to 0.4 m/s, and one at 1 m/s.
[[nodiscard]] std::vector<Case> panel(std::uint64_t seed);

/// What is judged. Each is a mean over the cases, except wrong and guard, which are sums.
enum Measure {
  kWrong,
  kGuard,
  kLostPull,
  kLostHold,
  kLostAfter,
  kWork,
  kPeak,
  kOverlap,
  kDeepest,
  kForce,
  kHold,
  kSlide,
  kHeld,
  kAfter,
  kMeasures
};
struct Column {
  const char *name, *meaning;
};
inline constexpr std::array<Column, kMeasures> kColumns{{
    {"wrong", "knots that are not what theory says, 0.5 s after the release"},
    {"guard", "guard events"},
    {"pull%", "time lost in the pull"},
    {"hold%", "time lost in the hold"},
    {"after%", "time lost after the release"},
    {"work", "contact work of a tick, million instructions"},
    {"peak", "the same, worst tick of a pull"},
    {"ovl", "overlap in the pull, diameters"},
    {"ovlH", "overlap in the hold, diameters"},
    {"force%", "force in the hold, of the force pulled to"},
    {"chat%", "chatter of the force in the hold"},
    {"slid%", "chatter of the force while sliding"},
    {"heldJ", "largest rise of energy in a tick while both hands stand still, uJ"},
    {"relJ", "the same after the release, uJ"},
}};
using Score = std::array<double, kMeasures>;

/// Runs one case.
[[nodiscard]] Score run(const Case& one);
/// Runs every case; the mean or sum of each measure.
[[nodiscard]] Score run(const std::vector<Case>& cases);

}  // namespace ligature::bench
