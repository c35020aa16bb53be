// The long experiments of `ligature-lab experiment` in a short form: the same claims on fewer cases. (The short ones
// run whole: CMakeLists.txt.)
#include <gtest/gtest.h>

#include "host/lab/experiments/experiment.hpp"
#include "host/lab/outcome.hpp"
#include "ligature_source_dir.hpp"
#include "tests/support/random.hpp"
#include "tests/support/temp_folder.hpp"

namespace ligature::lab {
namespace {

Bench quick() { return {std::string(LIGATURE_SOURCE_DIR) + "/scenes", test::temp_folder(), true, test::Random(91)()}; }

TEST(Haptics, EveryClaimOfTheQuickExperimentHolds) { EXPECT_EQ(experiment_haptics(quick()), kDone); }
TEST(Stability, EveryClaimOfTheQuickExperimentHolds) { EXPECT_EQ(experiment_stability(quick()), kDone); }
TEST(Unknotting, EveryClaimOfTheQuickExperimentHolds) { EXPECT_EQ(experiment_unknotting(quick()), kDone); }

}  // namespace
}  // namespace ligature::lab
