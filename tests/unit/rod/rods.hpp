#pragma once
// The validation's rods without a scene, for tests of parts of the rod model.

#include "host/lab/validate/rods.hpp"

namespace ligature::test {

using namespace ligature::validate;

}  // namespace ligature::test
