#include "sim_device/operator/throw.hpp"

#include "sim_device/operator/diagram.hpp"

namespace ligature::sim {

int determinant_of(const Throw& t) { return t.against ? 5 : 2 * t.passes + 1; }

bool would_hold(const Look& look, const Throw& t, const Vec3& out) {
  auto thread = look.thread.between(0.0, look.thread.length_m());
  const Vec3 back = look.place.anchor_W - look.sight.tool_W[kLeftHand];
  // Direction in which the thread is extended beyond the anchor: up and away from the left hand. So the extension does
  // not cross the loop, which hangs beside the standing part
  const Vec3 led = Vec3(back.x(), back.y(), 0.0).normalized() + Vec3::UnitZ();
  thread.insert(thread.begin(), look.place.anchor_W + look.place.length_m * led);
  return seen_determinant(thread, out) == t.tied_already * determinant_of(t);
}

}  // namespace ligature::sim
