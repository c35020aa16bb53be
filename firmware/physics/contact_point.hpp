#pragma once
// One contact of the thread, as it is shown outside of the physics.

#include "firmware/physics/types.hpp"

namespace ligature::physics {

/// A place where the thread touched itself, the desk or another body in the last time step.
struct ContactPoint {
  int segment = 0;               ///< number of the thread's segment: from this node to the next
  int other = -1;                ///< segment of the other strand; -1: the desk, a peg, a gripper or a hook
  Vec3 p_W = Vec3::Zero();       ///< between the two surfaces, m
  Vec3 normal_W = Vec3::Zero();  ///< unit, from the other towards the segment
  Vec3 f_W = Vec3::Zero();       ///< force ON THE SEGMENT, N, friction included; the other gets the opposite
  double gap_m = 0.0;            ///< distance of the surfaces before the step, negative: overlap
};

}  // namespace ligature::physics
