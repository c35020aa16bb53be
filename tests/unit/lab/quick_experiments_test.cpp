// The long experiments of `ligature-lab experiment` in a short form: the same claims on fewer cases. (The short ones
// run whole: CMakeLists.txt.)
#include <gtest/gtest.h>

#include <filesystem>

#include "host/lab/experiments/experiment.hpp"
#include "host/lab/outcome.hpp"
#include "host/lab/validate/proceed.hpp"
#include "ligature_source_dir.hpp"
#include "tests/support/random.hpp"
#include "tests/support/temp_folder.hpp"

namespace ligature::lab {
namespace {

Bench quick() { return {std::string(LIGATURE_SOURCE_DIR) + "/scenes", test::temp_folder(), true, test::Random(91)()}; }

TEST(Haptics, EveryClaimOfTheQuickExperimentHolds) { EXPECT_EQ(experiment_haptics(quick()), kDone); }
TEST(Stability, EveryClaimOfTheQuickExperimentHolds) { EXPECT_EQ(experiment_stability(quick()), kDone); }
TEST(Unknotting, EveryClaimOfTheQuickExperimentHolds) { EXPECT_EQ(experiment_unknotting(quick()), kDone); }

/// Every experiment heeds the request to stop, and writes no table of what it did not finish.
TEST(Experiments, InterruptedOnesWriteNothing) {
  struct Stopped {
    bool (*before)() noexcept = validate::stop_asked;
    Stopped() {
      validate::stop_asked = []() noexcept { return true; };
    }
    ~Stopped() { validate::stop_asked = before; }
  } const stopped;
  Bench bench = quick();
  bench.out /= "interrupted";
  std::filesystem::create_directories(bench.out);
  for (const auto experiment : {experiment_models, experiment_knotting, experiment_pulling, experiment_unknotting,
                                experiment_stability, experiment_extremes, experiment_cost, experiment_haptics})
    EXPECT_THROW(experiment(bench), validate::Interrupted);
  EXPECT_TRUE(std::filesystem::is_empty(bench.out));
}

}  // namespace
}  // namespace ligature::lab
