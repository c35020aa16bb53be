// Linked into every gtest program: a failing test prints its seed and the command that repeats it.
#include <gtest/gtest.h>

#include <cerrno>
#include <cstdio>

#include "tests/support/random.hpp"

namespace ligature::test {
namespace {

class SeedTold final : public testing::EmptyTestEventListener {
  void OnTestEnd(const testing::TestInfo& info) override {
    if (!info.result()->Failed()) return;
    std::printf("random input of LIGATURE_TEST_SEED=%llu; again: LIGATURE_TEST_SEED=%llu %s --gtest_filter=%s.%s\n",
                static_cast<unsigned long long>(seed_shift()), static_cast<unsigned long long>(seed_shift()),
                program_invocation_name, info.test_suite_name(), info.name());
  }
};

const bool kTold = [] {
  testing::UnitTest::GetInstance()->listeners().Append(new SeedTold);  // owned by the list
  return true;
}();

}  // namespace
}  // namespace ligature::test
