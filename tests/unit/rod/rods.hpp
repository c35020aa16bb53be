#pragma once
// The bare rods of the validation, for tests of the rod's own parts.

#include "host/lab/validate/rods.hpp"

namespace ligature::test {

using namespace ligature::validate;

}  // namespace ligature::test
