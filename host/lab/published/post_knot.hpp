#pragma once
// A sliding knot: two half hitches round a straight strand, tied round a post with a pre-tension, let go, and loaded.

#include "host/lab/published/case.hpp"
#include "host/lab/published/throws.hpp"

namespace ligature::published {

struct PostKnot {
  double friction = 0.3;
  double tying_N = 5.0;   ///< pre-tension of both ends
  bool sets = false;      ///< sharp bends become permanent (docs/rod-set.md)
  bool mirrored = false;  ///< the second hitch winds the other way round
};

struct PostResult {
  bool tied = false;        ///< the pre-tension was reached, with the knot that was laid
  double normal_N = 0.0;    ///< sum of the normal forces in the knot after letting go
  double grown_d = 0.0;     ///< thread that the knot and its loop took in after letting go, diameters
  double strength_N = 0.0;  ///< largest tension of the loop before a tail slipped by 5 d
};

[[nodiscard]] PostResult tie_on_post(const Subject& subject, const PostKnot& knot);

}  // namespace ligature::published
