// `ligature-lab experiment haptics` in a short form: the same claims on fewer cases.
#include <gtest/gtest.h>

#include "host/lab/experiments/experiment.hpp"
#include "host/lab/outcome.hpp"
#include "tests/support/temp_folder.hpp"

namespace ligature::lab {
namespace {

TEST(Haptics, EveryClaimOfTheQuickExperimentHolds) {
  EXPECT_EQ(experiment_haptics({std::string(LIGATURE_SOURCE_DIR) + "/scenes", test::temp_folder()}, true), kDone);
}

}  // namespace
}  // namespace ligature::lab
