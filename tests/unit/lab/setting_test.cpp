// Settings of `ligature-lab pareto --one`.

#include "host/lab/pareto/setting.hpp"

#include <gtest/gtest.h>

#include <string>

#include "host/lab/outcome.hpp"

namespace ligature::lab {
namespace {

std::string setting_refusal(const std::string& text) {
  try {
    static_cast<void>(setting_of(text));
  } catch (const Refusal& refusal) {
    EXPECT_EQ(refusal.code, kBadInput);
    return refusal.what();
  }
  return "taken";
}

TEST(ParetoSetting, IsReadAsItIsWritten) {
  for (const auto& setting : all_settings(false)) EXPECT_EQ(setting_of(setting.text()).text(), setting.text());
  for (const auto model : {scene::Model::kPaper1, scene::Model::kRod})
    EXPECT_EQ(setting_of(finest(model).text()).text(), finest(model).text());
}

TEST(ParetoSetting, OneThatNoThreadCanHaveIsRefusedWithTheRange) {
  const std::string form = "allowed MODEL/NODES/SUBSTEPS/PASSES or rod/NODES/PRESET", nodes = "allowed NODES 4 .. 5000";
  for (const auto& [text, says] : {std::pair<std::string, std::string>{"paper-4/0/1/4", nodes},
                                   {"paper-4/999999999/1/4", nodes},
                                   {"paper-4/99999999999999/1/4", nodes},
                                   {"rod/-50/fine", nodes},
                                   {"rod/50x/10/12", nodes},
                                   {"rod/50/0/12", "allowed SUBSTEPS 1 .. 10000"},
                                   {"rod/50/10/-1", "allowed PASSES 0 .. 1000"},
                                   {"rod/5000/10000/12", "allowed NODES times SUBSTEPS up to 2000000"},
                                   {"paper-4/50/fine", form},
                                   {"rod/50/best", form},
                                   {"rod/50/10/12/", form},
                                   {"tea/50/10/12", form},
                                   {"", form}}) {
    EXPECT_EQ(setting_refusal(text), "--one: found " + text + ", " + says);
  }
}

}  // namespace
}  // namespace ligature::lab
