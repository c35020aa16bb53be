#include <cmath>
#include <limits>

#include "host/lab/published/case.hpp"

namespace ligature::published {
namespace {

constexpr Case kCases[] = {
    // knots and braids in an elastic thread
    {"trefoil", "tension of an overhand knot that slides, friction 0.05",
     "Audoly, Clauvelin, Neukirch, PRL 99 (2007), constant as in dismech-newton", "sqrt(h / R)", "F h^2 / B", trefoil},
    {"braid", "overhand knots of n turns that slide, friction 0.119", "Jawed, Dieleman, Audoly, Reis, PRL 115 (2015)",
     "turns n", "n^2 F h^2 / (mu B)", braid},
    {"helices", "squared curvature of two strands round a bent backbone", "StructuresComp/surgeons-knot",
     "curvature of the backbone over k", "<delta''^2>, relative to a straight backbone", helices},
    {"ply", "a thread wound up by 20 turns, without friction", "Clauvelin, Audoly, Neukirch, JoMMS 4 (2009)",
     "angle of the ply (deg)", "F R^2 / B, M R / B", ply},
    // knots of throws in sutures
    {"locking", "friction at which square, granny, thief and grief lock",
     "Patil, Sandt, Kolle, Dunkel, Science 367 (2020)", "knot: 1 reef, 2 granny, 3 thief, 4 grief", "friction",
     locking},
    {"threshold", "friction above which a square knot holds, drawn at 5 mm/s", "no publication with figures found",
     "drawn knot", "friction", threshold},
    {"cyclic", "surgeon's knot 2-1-1 in 4-0 polypropylene under cycles of load",
     "Lee, Wong, Tay, BJSTR 17 (2019) 12716", "cycles", "slip of the tail, d", cyclic},
    {"post", "two-throw sliding knot tied on a post and let go",
     "Johanns, Baek, Grandgeorge, Guerid, Chester, Reis, Science Advances 9 (2023)", "friction",
     "strength over pre-tension", post},
    // friction round a bar
    {"capstan", "T_hi = T_lo exp(mu theta) round a peg", "Euler (1769), Eytelwein (1808)", "mu theta", "T_hi / T_lo",
     capstan},
    {"drum", "the same with a drum that turns below a thread that is held", "Euler (1769), Eytelwein (1808)",
     "mu theta", "T_hand / T_load", drum},
    {"capstan-axis", "a thread round a peg that moves along its axis: sliding force against tension",
     "Sabater, Park, Crassous, Neukirch, Reis, JMPS 213:106628 (2026)", "T R^2 / B", "F / (mu T)", capstan_axis},
};

}  // namespace

std::span<const Case> all_cases() { return kCases; }

Finding reported(std::string what, double measured, std::string unit) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  return {
      std::move(what), kNone, measured, std::isnan(measured) ? measured : 0.0, std::numeric_limits<double>::infinity(),
      std::move(unit)};
}

bool is_judged(const Finding& f) noexcept { return std::isfinite(f.tolerance); }

}  // namespace ligature::published
