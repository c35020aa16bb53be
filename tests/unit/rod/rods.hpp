#pragma once
// Makes the rods of `ligature-lab validate`, which need no scene file, available to tests of parts of the rod model.

#include "host/lab/validate/rods.hpp"

namespace ligature::test {

using namespace ligature::validate;

}  // namespace ligature::test
