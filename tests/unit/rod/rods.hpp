#pragma once
// Makes the rods of `ligature-lab validate`, which need no scene file, available to tests of parts of the rod model.

#include "firmware/physics/closest.hpp"
#include "host/lab/validate/rods.hpp"

namespace ligature::test {

using namespace ligature::validate;
using physics::Closest;
using physics::closest;

}  // namespace ligature::test
